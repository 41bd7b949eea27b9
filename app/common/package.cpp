#include "common/package.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "base/installed.h"
#include "common/console.h"

namespace dihaptic::app {

std::string python_folder() {
    const std::string facts = in_or_above_program(
        {"python/dihaptic/facts.json", "lib/python3/dist-packages/dihaptic/facts.json"});
    return facts.empty() ? "" : std::filesystem::path(facts).parent_path().parent_path().string();
}

Launch python_launch(const std::string& folder, const std::string& module) {
    // other Pythons, such as Anaconda's, lack the package; -I ignores the current folder, the
    // environment variables and the user's own packages. Until main() decides what Ctrl-C does,
    // Ctrl-C is first ignored, and then ends Python at once; by default, Python would print a
    // traceback of how it loads the package.
    const std::string code_of =
        "import signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
        "sys.path.insert(0, sys.argv.pop(1)); from dihaptic._parent import end_with; "
        "end_with(int(sys.argv.pop(1))); from " +
        module + " import main; sys.exit(main(sys.argv[1:]))";
    return {"/usr/bin/env",
            {"--ignore-signal=INT", "MPLBACKEND=agg", "/usr/bin/python3", "-I", "-c", code_of,
             folder, fmt::format("{}", getpid())},
            {Launch::kKept, Launch::kKept, Launch::kKept},
            Launch::kFreshSignals};
}

std::optional<int> wait_for_python(Child& python) {
    using namespace std::chrono_literals;
    constexpr auto kStep = 20ms;
    for (auto stopping = 0ms; !python.has_ended(); std::this_thread::sleep_for(kStep)) {
        if (!cli::stop_requested) continue;
        stopping += kStep;
        if (stopping == 1s) kill(python.process(), SIGINT);
        if (stopping == 30s) kill(python.process(), SIGKILL);
    }
    return python.wait();
}

}  // namespace dihaptic::app
