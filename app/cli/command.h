// The commands of the program, each a function that adds itself to the command line, and what they
// share.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::cli {

/// Set by Ctrl-C, by SIGTERM, and when the terminal is closed: the running command ends in order.
extern std::atomic<bool> stop_requested;

/// What the program returns: success, a result is bad, the input was bad.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

/// What the program will return; set by the command that ran.
extern int exit_code;

void add_run(CLI::App& app);
void add_replay(CLI::App& app);
void add_recover(CLI::App& app);
void add_resume(CLI::App& app);
void add_rehearse(CLI::App& app);
void add_collect(CLI::App& app);
void add_check(CLI::App& app);
void add_devices(CLI::App& app);
void add_bench(CLI::App& app);
void add_tune(CLI::App& app);
void add_picture(CLI::App& app);
void add_video(CLI::App& app);
void add_report(CLI::App& app);
void add_fit(CLI::App& app);
void add_export(CLI::App& app);
void add_gui(CLI::App& app);
void add_workspace(CLI::App& app);
void add_calibrate(CLI::App& app);

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

/// The command line as it was typed.
std::string command_line();
void remember_command_line(int argc, char** argv);

/// Prints problems, both warnings and errors.
void print(const std::vector<Problem>& problems, std::FILE* to = stderr);

/// Validators of the options --rate, --time and --seed.
CLI::Validator rate_range();
CLI::Validator time_range();
CLI::Validator seed_range();

}  // namespace dihaptic::cli
