#include "python_command.h"

#include <cstdio>
#include <cstring>

#include "command.h"
#include "common/package.h"

namespace dihaptic::cli {

void run_python(const std::string& file, const std::string& result, const std::string& module,
                const std::vector<std::string>& arguments) {
    const auto fault = [&](const std::string& why, const char* remedy) {
        return Error({file, 0}, "", "has no " + result + " yet" + why, remedy);
    };
    const std::string package = app::python_folder();
    if (package.empty())
        throw fault(", because the Python package computes it",
                    "Type sudo apt install python3-dihaptic or, in a checkout, ./dev build.");
    Launch launch = app::python_launch(package, module);
    launch.arguments.insert(launch.arguments.end(), arguments.begin(), arguments.end());
    std::fflush(stdout);  // must appear before the child's output
    Child python;
    if (const int failed = python.start(launch); failed != 0)
        throw fault(std::string(": Python cannot be started: ") + std::strerror(failed),
                    "End other programs and try again.");
    const int status = app::wait_for_python(python).value_or(-1);
    exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
    if (stop_requested && WIFSIGNALED(status)) throw Interrupted{};
}

}  // namespace dihaptic::cli
