// What the commands share: each is a function that adds itself to the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::cli {

/// Set by Ctrl-C, by SIGTERM, and when the terminal is closed: what runs comes to an orderly end.
extern std::atomic<bool> stop_requested;

/// What the program returns: success, some result was bad, the input was bad.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

/// Set by the command that ran.
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

/// One line of progress on standard error, redrawn in place on a terminal; elsewhere a line each
/// tenth.
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

/// Every line that was typed, as one.
std::string command_line();
void remember_command_line(int argc, char** argv);

/// Prints problems, warnings and errors alike.
void print(const std::vector<Problem>& problems, std::FILE* to = stderr);

/// What --rate takes, --time and --seed.
CLI::Validator rate_range();
CLI::Validator time_range();
CLI::Validator seed_range();

}  // namespace dihaptic::cli
