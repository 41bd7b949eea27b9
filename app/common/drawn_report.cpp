#include "common/drawn_report.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "analysis/report/report_json.h"
#include "base/child.h"
#include "base/descriptor.h"
#include "common/console.h"
#include "common/package.h"

namespace dihaptic::app {
namespace {

/// Creates a file in memory that contains this text, positioned at its beginning.
Descriptor in_memory(const std::string& text) {
    Descriptor file(memfd_create("dihaptic report", MFD_CLOEXEC));
    for (size_t at = 0; file && at < text.size();) {
        const ssize_t size = write(file.get(), text.data() + at, text.size() - at);
        if (size > 0) at += static_cast<size_t>(size);
        if (size < 0 && errno != EINTR) file.close();
    }
    if (file && lseek(file.get(), 0, SEEK_SET) != 0) file.close();
    return file;
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

void draw_page(const analysis::ReportResult& result, const std::string& command, PythonSays says) {
    const std::string folder = std::filesystem::path(result.page()).parent_path();
    const std::string package = python_folder();
    if (package.empty())
        throw no_page(folder, "the Python package draws it",
                      "Type sudo apt install python3-dihaptic or, in a checkout, ./dev build; or "
                      "add --tables, which needs no Python.");
    const Descriptor description = in_memory(analysis::report_json(result, command));
    const Descriptor said = in_memory("");
    Launch launch = python_launch(package, "dihaptic.reports.__main__");
    launch.files[0] = description.get();
    launch.arguments.insert(launch.arguments.end(), result.paths.begin(), result.paths.end());
    if (says == PythonSays::in_error)
        launch.files = {description.get(), Launch::kNothing, said.get()};
    std::fflush(stdout);  // the program's own output must come before the child's
    Child python;
    const int failed = description && said ? python.start(launch) : errno;
    if (failed != 0)
        throw no_page(folder, std::string("Python cannot be started: ") + std::strerror(failed),
                      "End other programs and try again.");
    if (wait_for_python(python) == 0) return;
    if (cli::stop_requested)
        throw no_page(folder, "it was interrupted", "Run the same command again.");
    const std::string words = says == PythonSays::in_error ? last_words_in(said) : "";
    throw no_page(folder, "Python did not draw it",
                  words.empty() ? "The lines above this one give the reason." : words);
}

}  // namespace dihaptic::app
