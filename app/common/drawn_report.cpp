#include "common/drawn_report.h"

#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "analysis/report/report_json.h"
#include "common/console.h"
#include "common/package.h"

namespace dihaptic::app {
namespace {

/// Sends a text, unless nobody receives it any more.
void send_all(const Descriptor& to, const std::string& text) {
    for (size_t at = 0; at < text.size();) {
        // without MSG_NOSIGNAL, a Python that has ended would end this program, too
        const ssize_t size = send(to.get(), text.data() + at, text.size() - at, MSG_NOSIGNAL);
        if (size < 0 && errno != EINTR) return;
        if (size > 0) at += static_cast<size_t>(size);
    }
}

/// The last lines of the file, which name the reason of a Python error.
std::string last_words_in(const Descriptor& file) {
    std::array<char, 2000> text{};
    const off_t end = lseek(file.get(), 0, SEEK_END);
    const off_t from = end > static_cast<off_t>(text.size()) ? end - text.size() : 0;
    const ssize_t size = pread(file.get(), text.data(), text.size(), from);
    std::string out(text.data(), size > 0 ? static_cast<size_t>(size) : 0);
    while (out.ends_with('\n')) out.pop_back();
    return out;
}

Error no_page(const std::string& folder, const std::string& why, const std::string& remedy) {
    const bool older = std::filesystem::exists(folder + "/report.html");
    return Error({folder, 0}, "",
                 (older ? "has no new report.html, only an older one, because "
                        : "has no report.html, because ") +
                     why,
                 remedy);
}

}  // namespace

PageDrawer::PageDrawer(const std::vector<std::string>& folders, PythonSays says)
    : package_(python_folder()), says_(says), said_(memfd_create("dihaptic report", MFD_CLOEXEC)) {
    if (package_.empty()) return;
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0 || !said_) {
        failed_ = errno;
        return;
    }
    description_ = Descriptor(ends[0]);
    const Descriptor of_python(ends[1]);
    Launch launch = python_launch(package_, "dihaptic.reports.__main__");
    launch.files[0] = of_python.get();
    launch.arguments.insert(launch.arguments.end(), folders.begin(), folders.end());
    if (says_ == PythonSays::in_error)
        launch.files = {of_python.get(), Launch::kNothing, said_.get()};
    failed_ = python_.start(launch);
}

void PageDrawer::draw(const analysis::ReportResult& result, const std::string& command) {
    const std::string folder = std::filesystem::path(result.page()).parent_path();
    if (package_.empty())
        throw no_page(folder, "the Python package draws it",
                      "Type sudo apt install python3-dihaptic or, in a checkout, ./dev build; or "
                      "add --tables, which needs no Python.");
    if (failed_ != 0)
        throw no_page(folder, std::string("Python cannot be started: ") + std::strerror(failed_),
                      "End other programs and try again.");
    std::fflush(stdout);  // the program's own output must come before Python's
    send_all(description_, analysis::report_json(result, command));
    description_.close();
    if (wait_for_python(python_) == 0) return;
    if (cli::stop_requested)
        throw no_page(folder, "it was interrupted", "Run the same command again.");
    const std::string words = says_ == PythonSays::in_error ? last_words_in(said_) : "";
    throw no_page(folder, "Python did not draw it",
                  words.empty() ? "The lines above this one give the reason." : words);
}

}  // namespace dihaptic::app
