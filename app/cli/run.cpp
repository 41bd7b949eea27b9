#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/figure.h"
#include "base/number.h"
#include "base/plural.h"
#include "base/text.h"
#include "command.h"
#include "common/stop_signals.h"
#include "common/study_turn.h"
#include "escape_key.h"
#include "person/population.h"
#include "resume_command.h"
#include "rig/calibration_guide.h"
#include "session/listeners/trial_controller.h"
#include "study/identifier.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct SessionOptions {
    session::Request request;
    session::RunOptions run;
    std::string solver;
    std::string coupling;
    std::string proxy;
    double rate = 0;
    std::string clock;
    bool simulate = false;
    std::string population_file;
    bool real_objects = false;
    std::string between;
    std::string despite;    ///< reason for starting a study's session against the study's rules
    std::string unstudied;  ///< a given option that is not allowed for a study
    /// Seed for drawing a study's simulated person; if unset, the session's seed is used.
    std::optional<uint64_t> person_seed;
};

/// Progress in words, e.g. "trial 12 of 96"; empty if there are no trials. `share`: share of
/// completed trials.
std::string trial_at(const session::Plan& plan, double share) {
    if (!plan.task) return "";
    const size_t all = plan.task->trials.size();
    const auto done = static_cast<size_t>(share * static_cast<double>(all));
    return fmt::format("trial {} of {}", std::min(all, done + 1), all);
}

/// The terminal during a session: reads its keys if the session runs on the real clock.
class Console {
  public:
    explicit Console(session::RunOptions& run) {
        run.warn = [](const std::string& message) { fmt::print("WARNING: {}\n", message); };
        run.waiting = [](const std::string& what) {
            fmt::print(stderr, "\nwaiting: {}\n", what);
            std::fflush(stderr);
        };
        if (run.clock != session::Clock::real) return;
        escape_.emplace(stop_requested, keys_);
        no_suspension_.emplace();
        run.keys = &keys_;
        run.stuck = [this](const std::string& message) {
            escape_->restore();
            fmt::print(stderr, "\nerror: {}\n", message);
            std::_Exit(kFailed);  // an orderly exit would wait for the stuck thread
        };
    }

    /// Makes the session check at its start, before it costs a person an hour, whether the
    /// calibration of real devices is still valid.
    void check_calibration(const session::Plan& plan, session::RunOptions& run) {
        const auto fingers = scene::finger_names(plan.scene);
        if (!escape_ || !escape_->listens() || !rig::can_check_together(plan.rig, fingers)) return;
        run.check = [&](devices::DeviceGroup& devices) { return check(plan, devices); };
    }

  private:
    /// Checks the calibration while the person holds the endpoints together; returns warnings.
    std::vector<Problem> check(const session::Plan& plan, devices::DeviceGroup& devices) {
        struct Skipped {};
        rig::Guide guide;
        guide.show = [](const rig::Guidance& now) {
            fmt::print("{} Then press Enter (S: skip this).\n", now.text);
            std::fflush(stdout);
        };
        guide.done = [this] {
            if (stop_requested) throw rig::GivenUp{};
            const char key = keys_.pop().value_or(0);
            if (key == 's' || key == 'S') throw Skipped{};
            return key == '\n' || key == '\r';
        };
        std::vector<Problem> warnings;
        try {
            const auto fingers = scene::finger_names(plan.scene);
            for (const rig::Together& pair :
                 rig::check_together(plan.rig, fingers, devices, guide)) {
                fmt::print("{}\n", pair.describe());
                if (!pair.agrees) warnings.push_back(pair.warning(plan.rig));
            }
        } catch (const Skipped&) {
            fmt::print("not checked\n");
        }
        print(warnings);
        return warnings;
    }

    ValueRing<char> keys_{task::kMostKeys};
    std::optional<EscapeKey> escape_;
    std::optional<app::NoSuspension> no_suspension_;
};

/// Whether a file contains a task for a person; otherwise, a script in the file moves the hand.
bool has_task(const std::string& file) {
    if (task::kind_of(file) != task::FileKind::experiment) return false;
    Diagnostics ignored;  // problems are reported when the plan is made
    return task::read_experiment(file, ignored).task.has_value();
}

/// Asks on the terminal for missing information about the person, and repeats a question if the
/// answer contains characters that cannot be recorded, such as the code of an arrow key.
void ask(recording::Participant& participant) {
    if (isatty(STDIN_FILENO) == 0) return;
    const auto question = [](const char* text, std::string& answer) {
        if (!answer.empty()) return;
        while (std::cin) {
            fmt::print("{}: ", text);
            std::fflush(stdout);
            std::getline(std::cin, answer);
            const auto fault = find_fault(answer, Lines::one);
            if (!fault) return;
            fmt::print("the answer {}; type it again without\n", fault->what);
            answer.clear();
        }
    };
    question("participant, e.g. S07", participant.id);
    question("age in years", participant.age);
    question("sex (F, M, O, or U: not stated)", participant.sex);
    question("handedness (right, left, both)", participant.handedness);
}

void run_one(SessionOptions& options) {
    const std::string& id = options.run.participant.id;
    const person::Population people = person::population_of(
        options.population_file,
        options.real_objects ? person::Objects::real : person::Objects::device);
    if (!people.groups.empty() && !options.run.in_study)
        options.request.order_number = people.number_in_group(id);
    session::Plan plan = session::make_plan(options.request);
    if (options.simulate && plan.task) {
        const uint64_t seed = options.person_seed.value_or(plan.seed);
        std::optional<person::Traits> partner;
        if (session::is_for_two(plan)) {
            std::string& other = options.run.partner.id;
            other = other.empty() ? session::partner_of(id) : recording::simulated_id(other);
            partner = person::draw_person(people, seed, other, people.group_of(id),
                                          people.laboratory_of(id));
        }
        session::sit_down(plan, person::draw_person(people, seed, id), partner);
        plan.moved_by.seed = number_text(seed);
    }
    std::optional<session::TrialController> controller;
    if (!options.between.empty()) {
        controller.emplace(options.between);
        controller->prepare(plan);
        options.run.controller = &*controller;
    }
    run_plan(std::move(plan), options.run);
}

}  // namespace

void run_plan(session::Plan plan, session::RunOptions run) {
    run.observers = true;
    auto devices = session::open_devices(plan, rig::is_real(plan.rig) ? host::program() : "",
                                         [] { return stop_requested.load(); });
    print(plan.warnings);
    fmt::print("{}\n", plan.title);
    Console console(run);
    console.check_calibration(plan, run);
    if (plan.movement) print_movement(*plan.movement, 12);
    if (run.clock == session::Clock::real) {
        // reported before the session has cost a person an hour, not after
        const int priority = plan.settings.real_time_priority;
        const auto refusals = servo::try_real_time(priority);
        if (refusals.any()) fmt::print("note: {}\n", servo::describe(refusals, priority));
        fmt::print("Escape or Ctrl-C switches force off at once, and ends the session.\n");
    }
    std::fflush(stdout);
    ProgressLine running("running");
    ProgressLine finishing("writing session.nwb");
    try {
        const session::Recorded session = session::record(
            plan, run, stop_requested,
            [&](double share) { running.show(share, trial_at(plan, share)); },
            [&](const std::string&, double share) {
                running.clear();
                finishing.show(share);
            },
            std::move(devices));
        finishing.clear();
        print_summary(session, plan);
        if (!session.good()) exit_code = kFailed;
    } catch (const rig::GivenUp&) {
        running.clear();
        fmt::print(stderr, "interrupted before it started: nothing was recorded\n");
        exit_code = kFailed;
    }
}

namespace {

double peak_force(const analysis::SessionFigures& figures) {
    double force = 0;
    for (const rows::PhaseRow& phase : figures.phases) force = std::max(force, phase.peak_force);
    return force;
}

const char* outcome_of(const analysis::SessionFigures& figures, bool interrupted) {
    if (figures.diverged()) return "diverged";
    if (figures.failed()) return "force off";
    return interrupted ? "interrupted" : "done";
}

/// The figures of a movement, in SI units, for its row in summary.csv. A movement that cannot be
/// run has no figures.
struct MovementFigures {
    std::string movement;
    std::string outcome = "refused";
    double duration = kUnmeasured, bridged_percent = kUnmeasured;
    std::optional<bool> mostly_bridged;
    std::optional<size_t> faults;
    double block = kUnmeasured, mean_grip = kUnmeasured, peak_grip = kUnmeasured;
    double peak_force = kUnmeasured;
    std::optional<int64_t> force_limited, rate_limited;
    double held = kUnmeasured, hold_slip = kUnmeasured, slid = kUnmeasured, flown = kUnmeasured;
    std::string session;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("movement", f.movement, "", "file");
        v("outcome", f.outcome, "", "done, interrupted, diverged, force off, or refused");
        v("duration", f.duration, "s", "duration of the movement");
        v("bridged_percent", f.bridged_percent, "1", "share of the movement that is bridged");
        v("mostly_bridged", f.mostly_bridged, "", "whether more than half is bridged");
        v("faults", f.faults, "1", "number of its faults");
        v("block", f.block, "mm", "width of the block");
        v("grasp_mean_grip", f.mean_grip, "N", "mean grip force in the phase 'grasp'");
        v("grasp_peak_grip", f.peak_grip, "N", "largest grip force in the phase 'grasp'");
        v("peak_force", f.peak_force, "N", "largest force in the session");
        v("force_limited_ticks", f.force_limited, "1", "ticks in which a force was limited");
        v("rate_limited_ticks", f.rate_limited, "1", "ticks in which a force's rate was limited");
        v("held", f.held, "s", "the object's longest hold");
        v("hold_slip", f.hold_slip, "mm", "slip in that hold");
        v("slid", f.slid, "mm", "total path along its support");
        v("flown", f.flown, "s", "total time untouched in the air");
        v("session", f.session, "", "folder");
    }
};

/// Finds the episodes in which the object was handled.
void find_handling(MovementFigures& out, const std::vector<analysis::Episode>& episodes) {
    out.held = out.slid = out.flown = 0;
    for (const analysis::Episode& e : episodes) {
        const double lasted = e.end - e.start;
        if (e.kind == rows::EpisodeKind::slide) out.slid += e.distance;
        if (e.kind == rows::EpisodeKind::flight) out.flown += lasted;
        if (e.kind != rows::EpisodeKind::hold || lasted <= out.held) continue;
        out.held = lasted;
        out.hold_slip = e.slip;
    }
}

/// Runs one movement of a batch and returns its figures.
MovementFigures run_movement(const SessionOptions& options, const std::string& name) {
    const session::Plan plan = session::make_plan(options.request);
    const session::Recorded session = session::record(plan, options.run, stop_requested);
    const analysis::SessionFigures& figures = session.figures;
    const session::MovementReport& report = *plan.movement;
    MovementFigures out;
    out.movement = name;
    out.outcome = outcome_of(figures, session.interrupted);
    out.duration = report.duration;
    out.bridged_percent = 100 * report.bridged_share;
    out.mostly_bridged = report.bridged_share > hand::kMuchBridged;
    out.faults = report.faults.size();
    out.block = report.block_width;
    if (const rows::PhaseRow* grasp = figures.phase("grasp")) {
        out.mean_grip = grasp->mean_grip;
        out.peak_grip = grasp->peak_grip;
    }
    out.peak_force = peak_force(figures);
    out.force_limited = figures.ticks_with(kForceLimited);
    out.rate_limited = figures.ticks_with(kRateLimited);
    find_handling(out, figures.episodes);
    out.session = session.folder;
    if (figures.failed()) exit_code = kFailed;
    fmt::print("{:28s} {:7.2f} {:6.1f} %{} {:6d} {:5.1f} mm {:8.3f} {:8.3f} {:8.3f} {:8d}  {}{}\n",
               name, out.duration, out.bridged_percent, *out.mostly_bridged ? '!' : ' ',
               *out.faults, out.block * 1e3, out.mean_grip, out.peak_grip, out.peak_force,
               *out.force_limited,
               figures.diverged() ? "DIVERGED "
               : figures.failed() ? "FORCE OFF "
                                  : "",
               out.session);
    return out;
}

std::vector<std::string> movements_in(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (task::is_movement(entry.path().string())) files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        throw Error({folder, 0}, "", "this folder contains no .csv or .tsv file",
                    "Name a movement, or a folder of them.");
    }
    return files;
}

/// Runs all movements in a folder, with one session and one row of the summary for each. The
/// summary is written after every movement, so that nothing is lost if the next movement fails.
void run_batch(SessionOptions& options) {
    const Console console(options.run);
    const std::vector<std::string> files = movements_in(options.request.movement);
    const std::string table = options.run.out + "/summary.csv";
    std::vector<MovementFigures> rows;
    const auto save = [&] { write_csv(figure_table<MovementFigures>(rows), table); };
    std::error_code failed;
    fs::create_directories(options.run.out, failed);
    save();
    fmt::print("{:28s} {:>7s} {:>8s}  {:>6s} {:>8s} {:>8s} {:>8s} {:>8s} {:>8s}  {}\n", "movement",
               "s", "bridged", "faults", "block", "grip N", "peak N", "force N", "limited",
               "session");
    size_t refused = 0;
    for (const std::string& file : files) {
        if (stop_requested) break;
        SessionOptions one = options;
        one.request.movement = file;
        const std::string name = fs::path(file).filename().string();
        try {
            rows.push_back(run_movement(one, name));
        } catch (const std::exception& e) {
            ++refused;
            rows.emplace_back().movement = name;
            fmt::print("{:28s} refused\n", name);
            fmt::print(stderr, "{}\n", e.what());
        }
        std::fflush(stdout);
        save();
    }
    fmt::print(
        "\ngrip, peak: mean and largest grip force of the grasp; force: largest on any finger; "
        "limited: ticks in which\na force was cut to the largest allowed; !: more than half of the "
        "movement is bridged\n");
    fmt::print("{}, {} refused; summary: {}\n",
               counted(static_cast<int64_t>(rows.size()), "movement"), refused, table);
    if (refused > 0 || stop_requested) exit_code = kFailed;
}

/// Adds the settings that were given by options of their own.
void add_settings(SessionOptions& options) {
    if (!options.solver.empty()) options.request.set.push_back("dynamics.solver=" + options.solver);
    if (!options.coupling.empty())
        options.request.set.push_back("coupling.kind=" + options.coupling);
    if (!options.proxy.empty()) options.request.set.push_back("proxy.kind=" + options.proxy);
    if (options.rate > 0) options.request.set.push_back(fmt::format("rate_Hz={}", options.rate));
}

/// Prepares the participant's next session in a study; does nothing if the file is not a study.
/// Returns the folder of a session to be resumed; empty if there is none.
std::string take_turn(SessionOptions& options) {
    if (task::kind_of(options.request.file) != task::FileKind::study) {
        if (options.despite.empty()) return "";
        throw Error({"--despite", 0}, "", "concerns the rules of a study",
                    "Leave it out, or name a study's file.");
    }
    if (!options.unstudied.empty()) {
        throw Error({options.unstudied, 0}, "",
                    "is not possible for a study, whose files determine it",
                    "Leave it out, or run the experiment itself.");
    }
    const auto tell = [](const std::string& line) {
        fmt::print(line.starts_with("WARNING") ? stderr : stdout, "{}\n", line);
        std::fflush(stdout);
    };
    const app::StudyTurn turn = app::study_turn(options.request.file, options.run.participant.id,
                                                options.despite, options.simulate, tell);
    options.request.file = turn.experiment;
    options.request.order_number = turn.in_study.number;
    options.request.seed = turn.seed;
    options.person_seed = turn.person_seed;
    options.run.participant = turn.participant;
    options.run.in_study = turn.in_study;
    options.run.out = turn.out;
    if (!options.simulate && !session::on_real_devices(options.request)) {
        throw Error({options.request.file, 0}, "rig", "is simulated: no person can take part",
                    "Name a rig with devices (--rig), or rehearse the session: --simulate.");
    }
    if (!options.run.partner.id.empty())
        study::check_identifier(options.run.partner.id, "--partner");
    if (!turn.resume.empty() && !options.run.partner.id.empty())
        throw Error({"--partner", 0}, options.run.partner.id,
                    "is known from the session that is resumed", "Leave it out.");
    turn.log_begin();
    return turn.resume;
}

void run(SessionOptions& options) {
    add_settings(options);
    const std::string resume = take_turn(options);
    if (!resume.empty()) {
        resume_session(resume, "", options.run.sync);
        return;
    }
    if (options.simulate && options.clock == "real")
        throw Error({"--simulate", 0}, "", "runs on the virtual clock", "Leave out --clock real.");
    options.request.simulate = options.simulate;
    const bool real = session::on_real_devices(options.request);
    if (real && options.clock == "virtual") {
        throw Error({"--clock", 0}, "", "real devices run in real time",
                    "Leave out --clock, or run on simulated devices: --simulate, or --rig "
                    "rigs/premium-pair.yaml.");
    }
    options.run.clock =
        real || options.clock == "real" ? session::Clock::real : session::Clock::virtual_clock;
    options.run.command = command_line();
    const bool task = has_task(options.request.file);
    // only a human participant can be asked
    if (real && task) ask(options.run.participant);
    if (real && !options.run.participant.id.empty())
        study::check_identifier(options.run.participant.id, "--participant");
    if (options.simulate && task)
        options.run.participant.id = recording::simulated_id(options.run.participant.id);
    options.request.participant = options.run.participant.id;
    if (fs::is_directory(options.request.movement)) {
        run_batch(options);
    } else {
        run_one(options);
    }
}

void add_simulated_person(CLI::App* command, const std::shared_ptr<SessionOptions>& options) {
    auto* simulate = command->add_flag(
        "--simulate", options->simulate,
        "a simulated person on simulated devices does the trials, on the virtual clock");
    auto* population =
        command->add_option("--population", options->population_file,
                            "population file from which the person is drawn; default: the "
                            "program's own, as in populations/adults.yaml");
    population->transform(given_or_kept())->needs(simulate);
    command
        ->add_flag("--real-objects", options->real_objects,
                   "the person grips as they would without a device")
        ->needs(simulate)
        ->excludes(population);
}

void add_participant_facts(CLI::App* command, const std::shared_ptr<SessionOptions>& options) {
    command->add_option("--participant", options->run.participant.id,
                        "participant's identifier; for a simulated person it starts with sim-");
    command->add_option("--partner", options->run.partner.id,
                        "identifier of the second participant, in a task for two");
    command->add_option("--age", options->run.participant.age, "participant's age in years");
    command->add_option("--sex", options->run.participant.sex, "F, M, O, or U: not stated")
        ->check(CLI::IsMember({"F", "M", "O", "U"}));
    command->add_option("--handedness", options->run.participant.handedness, "right, left or both")
        ->check(CLI::IsMember({"right", "left", "both"}));
}

void add_physics(CLI::App* command, const std::shared_ptr<SessionOptions>& options) {
    command->add_option(
        "--solver", options->solver,
        fmt::format("contact solver: {}", fmt::join(enum_names(contact::Solver{}), ", ")));
    command->add_option("--coupling", options->coupling,
                        fmt::format("coupling of handle and proxy: {}",
                                    fmt::join(enum_names(frame::CouplingKind{}), ", ")));
    command->add_option("--proxy", options->proxy,
                        fmt::format("model of a finger in the world: {}",
                                    fmt::join(enum_names(scene::ProxyKind{}), ", ")));
}

}  // namespace

void add_run(CLI::App& app) {
    auto* command = app.add_subcommand("run", "Run a scene or an experiment, and record it");
    auto options = std::make_shared<SessionOptions>();
    command->add_option("FILE", options->request.file, "scene, experiment or study")
        ->transform(given_or_kept())
        ->required();
    command
        ->add_option(
            "--movement", options->request.movement,
            "recorded movement (CSV) that pulls the simulated fingers, or a folder of movements")
        ->transform(given_or_kept());
    command->add_option("--rig", options->request.rig, "rig file, in place of the experiment's")
        ->transform(given_or_kept());
    add_simulated_person(command, options);
    add_participant_facts(command, options);
    command->add_option("--despite", options->despite,
                        "reason for beginning a session of a study against the study's rules");
    add_physics(command, options);
    command->add_option("--rate", options->rate, "ticks per second [Hz]")->check(rate_range());
    command
        ->add_option("--clock", options->clock,
                     "virtual: as fast as possible, with identical results every time; real: real "
                     "time; default: virtual, or real with real devices")
        ->check(CLI::IsMember({"virtual", "real"}));
    command->add_option("--out", options->run.out, "folder in which sessions' folders are made")
        ->capture_default_str();
    command
        ->add_option("--sync", options->run.sync,
                     "interval at which the recording is synchronised to the disk [s]: the most "
                     "that a power cut can destroy; default: only at the session's end")
        ->check(CLI::Range(0.05, 3600.0));
    command->add_option("--seed", options->request.seed, "seed of all random numbers")
        ->check(seed_range())
        ->capture_default_str();
    command->add_option("--between", options->between,
                        "UNIX socket of a program that decides, after each trial, what comes "
                        "next: docs/python.md");
    command->add_option("--set", options->request.set,
                        "any setting, e.g. coupling.stiffness_N_m=600; may be repeated");
    command->footer(
        "\nExamples:\n"
        "  dihaptic run experiments/lift-block.yaml\n"
        "  dihaptic run experiments/visuomotor-rotation.yaml --simulate --participant sim-007 "
        "--seed 7\n"
        "  dihaptic run my-study.yaml --participant S07\n"
        "  dihaptic run scenes/frictionless-plane.yaml --clock real\n"
        "  dihaptic run scenes/block-on-table.yaml --rig rigs/omega-pair.yaml\n"
        "  dihaptic run experiments/reach-to-grasp.yaml --movement trial01.csv --participant S07\n"
        "  dihaptic run experiments/lift-block.yaml --set coupling.stiffness_N_m=600 --set "
        "dynamics.every=10");
    command->callback([options, command] {
        for (const char* option : {"--set", "--seed", "--rate", "--solver", "--coupling", "--proxy",
                                   "--age", "--sex", "--handedness", "--out", "--movement"}) {
            if (command->count(option) > 0) options->unstudied = option;
        }
        run(*options);
    });
}

}  // namespace dihaptic::cli
