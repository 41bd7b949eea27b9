// Shared by the command-line programs: parsing, progress, and orderly ends.
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

/// Set by Ctrl-C, by SIGTERM, and when the terminal is closed: the running command then ends in an
/// orderly way.
extern std::atomic<bool> stop_requested;

/// Exit codes: success; a result is bad, or the command was interrupted; the input was bad.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

/// The exit code; set by the command that ran.
extern int exit_code;

/// Parses the command line, which names one of `app`'s commands, and runs that command. Prints any
/// error that it throws. Returns the program's exit code.
int run_program(CLI::App& app, int argc, char** argv);

/// A line of progress on standard error, redrawn in place on a terminal; elsewhere a new line for
/// each tenth.
class ProgressLine {
  public:
    explicit ProgressLine(std::string label);
    ~ProgressLine();
    void show(double share, const std::string& what = "");
    void clear();

  private:
    std::string label_;
    bool terminal_;
    int shown_ = -1;
    size_t width_ = 0;
};

/// Calls `work` with a function that shows its progress, and returns its result.
template <class Work>
auto with_progress(const std::string& label, const Work& work) {
    ProgressLine line(label);
    return work([&](const std::string& what, double share) { line.show(share, what); });
}

/// Prints problems, both warnings and errors.
void print(const std::vector<Problem>& problems, std::FILE* to = stderr);

/// Validators of the options --rate, --time and --seed.
CLI::Validator rate_range();
CLI::Validator time_range();
CLI::Validator seed_range();

/// Replaces the name of a missing file by that of a file that comes with the program, or that is in
/// the user's own folder (base/installed.h).
CLI::Validator given_or_kept();

/// The flag --json.
void add_json(CLI::App& command, bool& json);

/// An option whose value is one of an enum's names, which its help lists.
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
