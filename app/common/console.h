// Shared by the command-line programs: parsing, progress, and orderly termination.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::cli {

/// Set by Ctrl-C, by SIGTERM, and when the terminal is closed. The running command then ends in an
/// orderly way.
extern std::atomic<bool> stop_requested;

/// Exit codes: success; a bad result or an interrupted command; bad input.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

/// The program's exit code, set by the command that ran.
extern int exit_code;

/// Parses the command line, which names one of `app`'s commands, and runs that command. If the
/// command throws an error, prints it. Returns the program's exit code.
int run_program(CLI::App& app, int argc, char** argv);

/// Thrown to end a command that the user has interrupted; run_program() reports it.
struct Interrupted {};

/// A progress line on standard error. On a terminal, the line is redrawn in place; elsewhere, a new
/// line is printed after each tenth of the work.
class ProgressLine {
  public:
    explicit ProgressLine(std::string label);
    ~ProgressLine();
    void show(double share, const std::string& what = "");
    /// Shows the progress of work that may be abandoned anywhere. Throws Interrupted if the program
    /// is to stop.
    void show_or_stop(double share, const std::string& what = "");
    void clear();

  private:
    std::string label_;
    bool terminal_;
    int shown_ = -1;
    size_t width_ = 0;
};

/// Calls `work` with a function that displays the progress, and returns the result of `work`.
template <class Work>
auto with_progress(const std::string& label, const Work& work) {
    ProgressLine line(label);
    return work([&](const std::string& what, double share) { line.show(share, what); });
}

/// Prints problems, i.e. warnings and errors.
void print(const std::vector<Problem>& problems, std::FILE* to = stderr);

/// Validators for the options --rate, --time and --seed.
CLI::Validator rate_range();
CLI::Validator time_range();
CLI::Validator seed_range();

/// If a file does not exist, replaces its name with that of a file that comes with the program or
/// that is in the user's own folder (base/installed.h).
CLI::Validator given_or_kept();

/// Adds the flag --json.
void add_json(CLI::App& command, bool& json);

/// Adds an option whose value is one of the names of an enum; its help text lists them.
template <NamedEnum E>
CLI::Option* add_choice(CLI::App& command, const std::string& option, E& value,
                        const std::string& what) {
    const auto names = enum_names(E{});
    const auto choose = [&value, names](const std::string& word) {
        value = static_cast<E>(std::find(names.begin(), names.end(), word) - names.begin());
    };
    return command.add_option_function<std::string>(option, choose, what)
        ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
}

}  // namespace dihaptic::cli
