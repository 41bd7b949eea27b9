#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/companion.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

constexpr const char* kProgram = "dihaptic-gui";

/// Replaces this process with the window program.
void run(const std::vector<std::string>& files, const std::string& out, double sync) {
    const auto is_set = [](const char* name) {
        const char* value = std::getenv(name);
        return value != nullptr && *value != '\0';
    };
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("QT_QPA_PLATFORM")) {
        throw Error(
            "there is no screen for a window",
            "Start it on a desktop, or log in with ssh -X; dihaptic run does not need a screen.");
    }
    const std::string program = companion(kProgram);
    std::vector<std::string> words{kProgram, "--out", out, "--sync", fmt::format("{}", sync)};
    words.insert(words.end(), files.begin(), files.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    throw Error(fmt::format("{} cannot be started: {}", program.empty() ? kProgram : program,
                            std::strerror(program.empty() ? ENOENT : errno)),
                kCompanionMissing);
}

}  // namespace

void add_gui(CLI::App& app) {
    struct Options {
        std::vector<std::string> files;
        std::string out = "sessions";
        double sync = 0;  // [s]
    };
    auto* command = app.add_subcommand(
        "gui", "The operator's window; without devices, the mouse moves a simulated hand");
    auto options = std::make_shared<Options>();
    command->add_option("FILE", options->files,
                        "scene or experiment, or folders of recorded sessions, of which two are "
                        "shown side by side; without any, a start page is shown");
    command->add_option("--out", options->out, "folder in which sessions' folders are made")
        ->capture_default_str();
    command->add_option("--sync", options->sync, "as in dihaptic run [s]")
        ->check(CLI::Range(0.05, 3600.0));
    command->footer(
        "\nExamples:\n  dihaptic gui scenes/block-on-table.yaml\n"
        "  dihaptic gui sessions/2026-11-20_101500_lift-block");
    command->callback([options] { run(options->files, options->out, options->sync); });
}

}  // namespace dihaptic::cli
