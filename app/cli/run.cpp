#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/plural.h"
#include "base/table.h"
#include "command.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    experiment::Request request;
    experiment::RunOptions run;
    std::string solver;
    std::string coupling;
    double rate = 0;
    std::string clock = "virtual";
};

void run_one(const Options& options) {
    const experiment::Plan plan = experiment::make_plan(options.request);
    print(plan.warnings);
    fmt::print("{}\n", plan.title);
    if (plan.movement) print_movement(*plan.movement, 12);
    std::fflush(stdout);
    experiment::RunResult result;
    {
        ProgressLine line("running");
        result = experiment::run_session(plan, options.run, stop_requested,
                                         [&](double share) { line.show(share); });
    }
    print_summary(finish(result), plan, result);
    if (result.interrupted) exit_code = kFailed;
}

/// A folder of movements: a session each, and a summary row each.
void run_batch(const Options& options) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(options.request.movement)) {
        if (entry.path().extension() == ".csv") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    if (files.empty())
        throw Error({options.request.movement, 0}, "", "this folder has no .csv file",
                    "Name a movement, or a folder of them.");

    Table summary;
    summary.columns = {
        {"movement", ""},           {"outcome", ""},      {"duration_s", ""},
        {"bridged_percent", ""},    {"faults", ""},       {"block_mm", ""},
        {"peak_grip_N", ""},        {"peak_force_N", ""}, {"force_limited_ticks", ""},
        {"rate_limited_ticks", ""}, {"session", ""}};
    fmt::print("{:28s} {:>7s} {:>8s} {:>7s} {:>8s} {:>8s} {:>8s}  {}\n", "movement", "s", "bridged",
               "faults", "block", "grip N", "force N", "session");
    size_t refused = 0;
    for (const std::string& file : files) {
        if (stop_requested) break;
        Options one = options;
        one.request.movement = file;
        const std::string name = fs::path(file).filename().string();
        try {
            const experiment::Plan plan = experiment::make_plan(one.request);
            const experiment::RunResult result =
                experiment::run_session(plan, one.run, stop_requested, {});
            const analysis::SessionFigures figures = analysis::finish_session(
                recording::SessionFolder::open(result.folder), result.info, {});
            double grip = 0;
            double force = 0;
            for (const analysis::PhaseFigures& phase : figures.phases) {
                grip = std::fmax(grip, phase.peak_grip);
                force = std::max(force, phase.peak_force);
            }
            const auto ticks = [&](servo::Status bit) {
                return static_cast<double>(figures.status_ticks[static_cast<size_t>(
                    std::countr_zero(static_cast<unsigned>(bit)))]);
            };
            const experiment::MovementReport& report = *plan.movement;
            summary.rows.push_back(
                {name, "done", report.duration, 100 * report.bridged_share,
                 static_cast<double>(report.faults.size()), report.block_width * 1e3, grip, force,
                 ticks(servo::kForceLimited), ticks(servo::kRateLimited), result.folder});
            fmt::print("{:28s} {:7.2f} {:6.1f} % {:7d} {:5.1f} mm {:8.3f} {:8.3f}  {}\n", name,
                       report.duration, 100 * report.bridged_share, report.faults.size(),
                       report.block_width * 1e3, grip, force, result.folder);
        } catch (const Error& e) {
            ++refused;
            summary.rows.push_back({name, "refused", NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, ""});
            fmt::print("{:28s} refused\n", name);
            fmt::print(stderr, "{}\n", e.what());
        }
        std::fflush(stdout);
    }
    const std::string table = options.run.out + "/summary.csv";
    fs::create_directories(options.run.out);
    write_csv(summary, table);
    fmt::print("{}, {} refused; summary: {}\n",
               counted(static_cast<int64_t>(summary.rows.size()), "movement"), refused, table);
    if (refused > 0 || stop_requested) exit_code = kFailed;
}

void run(Options& options) {
    // settings that have an option of their own
    if (!options.solver.empty()) options.request.set.push_back("dynamics.solver=" + options.solver);
    if (!options.coupling.empty())
        options.request.set.push_back("coupling.kind=" + options.coupling);
    if (options.rate > 0) options.request.set.push_back(fmt::format("rate_Hz={}", options.rate));
    options.run.clock =
        options.clock == "real" ? experiment::Clock::real : experiment::Clock::virtual_clock;
    options.run.command = command_line();
    if (fs::is_directory(options.request.movement)) {
        run_batch(options);
    } else {
        run_one(options);
    }
}

}  // namespace

void add_run(CLI::App& app) {
    auto* command = app.add_subcommand("run", "Run a scene or an experiment, and record it");
    auto options = std::make_shared<Options>();
    command->add_option("FILE", options->request.file, "scene or experiment")->required();
    command->add_option(
        "--movement", options->request.movement,
        "recorded movement (CSV) that pulls the simulated fingers, or a folder of them");
    command->add_option("--rig", options->request.rig, "rig file, in place of the experiment's");
    command->add_option("--participant", options->run.participant.id, "participant's identifier");
    command->add_option("--solver", options->solver, "contact solver: sequential_impulse");
    command->add_option("--coupling", options->coupling,
                        "coupling of handle and proxy: implicit, dual_spring");
    command->add_option("--proxy", "what a finger is in the world: rigid")
        ->check(CLI::IsMember({"rigid"}));
    command->add_option("--rate", options->rate, "ticks a second [Hz]")->check(CLI::PositiveNumber);
    command
        ->add_option("--clock", options->clock,
                     "virtual: as fast as the machine goes, the same every time; real: real time")
        ->check(CLI::IsMember({"virtual", "real"}))
        ->capture_default_str();
    command->add_option("--out", options->run.out, "folder for session folders")
        ->capture_default_str();
    command->add_option("--seed", options->request.seed, "of everything random")
        ->capture_default_str();
    command->add_option("--set", options->request.set,
                        "any setting, e.g. coupling.stiffness_N_m=600; may be repeated");
    command->footer(
        "\nExamples:\n"
        "  dihaptic run experiments/lift-block.yaml\n"
        "  dihaptic run scenes/frictionless-plane.yaml --clock real\n"
        "  dihaptic run experiments/reach-to-grasp.yaml --movement trial01.csv --participant S07\n"
        "  dihaptic run experiments/lift-block.yaml --set coupling.stiffness_N_m=600 --set "
        "dynamics.every=10");
    command->callback([options] { run(*options); });
}

}  // namespace dihaptic::cli
