// The commands of the program. Each command is a function that adds itself to the command line.
#pragma once

#include <string>

#include "common/console.h"

namespace dihaptic::cli {

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
void add_power(CLI::App& app);
void add_report(CLI::App& app);
void add_fit(CLI::App& app);
void add_export(CLI::App& app);
void add_gui(CLI::App& app);
void add_workspace(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_calibrate_population(CLI::App& app);
void add_register(CLI::App& app);
void add_participant(CLI::App& app);
void add_new(CLI::App& app);
void add_schema(CLI::App& app);
void add_doctor(CLI::App& app);

/// Returns the command line as typed.
std::string command_line();

}  // namespace dihaptic::cli
