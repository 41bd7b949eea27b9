#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "base/field_writer.h"
#include "base/number.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "command.h"
#include "crowd.h"
#include "person/population.h"
#include "person/simulated_limits.h"
#include "rehearse_command.h"
#include "session/rehearsal.h"
#include "session/unfinished_folder.h"
#include "shards.h"
#include "study_rehearsal.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;
using session::Asked;
using session::person_id;

struct RehearseOptions {
    session::Request request;
    std::string out;
    std::string shard = "1/1";
    std::string population_file;
    std::optional<person::Population> population;
    int people = 1;
    int laboratories = 0;  ///< from which the people come; 0 for as many as the population says
    int jobs = 1;
    int slurm = 0;          ///< number of shards for Slurm; 0 to run here
    std::string container;  ///< Apptainer file whose program runs the shards; "" for this program
    bool real_objects = false;
    bool keep_recordings = false;
};

struct Shard {
    int number = 1;  ///< from 1
    int of = 1;      ///< total number of shards
};

Shard parse_shard(const std::string& text) {
    const size_t slash = std::min(text.find('/'), text.size());
    const Shard shard{
        whole_number<int>(std::string_view(text).substr(0, slash)).value_or(0),
        whole_number<int>(std::string_view(text).substr(std::min(slash + 1, text.size())))
            .value_or(0)};
    if (shard.number < 1 || shard.number > shard.of) {
        throw Error({"--shard", 0}, text, "is not a valid part",
                    "Write e.g. --shard 3/20: the third of twenty parts.");
    }
    return shard;
}

/// Runs one person's session, in the process started for it. Returns the exit status.
int run_person(const RehearseOptions& options, const std::string& id,
               const session::UnfinishedFolder& place) {
    try {
        dup2(place.messages(), STDOUT_FILENO);
        dup2(place.messages(), STDERR_FILENO);
        if (place.is_done()) {  // another program has just completed the session
            place.remove();
            return kOk;
        }
        session::Request request = options.request;
        request.participant = id;
        request.order_number = options.population->number_in_group(id);
        session::Plan plan = session::make_plan(request);
        session::RunOptions run;
        std::optional<person::Traits> partner;
        if (session::is_for_two(plan)) {
            run.partner.id = session::partner_of(id);
            partner = person::draw_person(*options.population, plan.seed, run.partner.id,
                                          options.population->group_of(id),
                                          options.population->laboratory_of(id));
        }
        session::sit_down(plan, person::draw_person(*options.population, plan.seed, id), partner);
        run.out = place.path();
        run.command = command_line();
        run.participant.id = id;
        run.keep_log = options.keep_recordings;
        const session::Recorded session = session::record(plan, run, stop_requested);
        if (!session.good()) {
            if (!session.fault.empty()) {
                fmt::print("{}\n", session.fault);
            } else if (!session.interrupted) {
                fmt::print("the simulation diverged\n");
            }
            return kFailed;
        }
        place.finish(session.folder);
        place.remove();
        return kOk;
    } catch (const std::exception& e) {
        fmt::print("{}\n", e.what());
        std::fflush(stdout);
        return kFailed;
    }
}

std::string usual_folder(const session::Request& request) {
    return fmt::format("rehearsals/{}_{}", fs::path(request.file).stem().string(), request.seed);
}

/// The people of a shard.
struct Roster {
    std::vector<std::string> waiting;
    int there = 0;  ///< number of people whose sessions were already complete at the start
};

Roster roster_of(const RehearseOptions& options, const Shard& shard) {
    Roster roster;
    for (int person = shard.number; person <= options.people; person += shard.of) {
        if (session::has_session(options.out + "/" + person_id(person))) {
            ++roster.there;
        } else {
            roster.waiting.push_back(person_id(person));
        }
    }
    return roster;
}

/// The work for each person of a rehearsal.
CrowdWork work_of(const RehearseOptions& options) {
    CrowdWork work;
    work.jobs = options.jobs;
    work.out = options.out;
    work.start = [&options](const std::string& id) -> std::optional<pid_t> {
        const auto place = session::UnfinishedFolder::take(options.out, id);
        if (!place) return std::nullopt;
        return start_process([&] { return run_person(options, id, *place); });
    };
    work.is_done = [&options](const std::string& id) {
        return session::has_session(options.out + "/" + id);
    };
    work.messages = [&options](const std::string& id) {
        return session::messages_of(options.out, id);
    };
    return work;
}

/// The command that runs the sessions of all people of this rehearsal, from any folder.
std::string command_again(const RehearseOptions& options) {
    return RehearseCommand{.file = options.request.file,
                           .people = options.people,
                           .seed = number_text(options.request.seed),
                           .out = options.out,
                           .population = options.population_file,
                           .laboratories = options.laboratories,
                           .real_objects = options.real_objects,
                           .keep_recordings = options.keep_recordings,
                           .jobs = options.jobs,
                           .container = options.container}
        .text();
}

/// The population from which the people are drawn, with as many laboratories as were asked for.
person::Population population_of(const RehearseOptions& options) {
    person::Population out = person::population_of(
        options.population_file,
        options.real_objects ? person::Objects::real : person::Objects::device);
    if (options.laboratories > 0) out.laboratories = options.laboratories;
    return out;
}

/// One person alone would not show how the people of a laboratory differ.
void check_laboratories(const RehearseOptions& options) {
    const int laboratories = options.population->laboratories;
    if (laboratories == 0 || options.people >= 2 * laboratories) return;
    throw Error(
        {"--laboratories", 0}, "",
        fmt::format(
            "{} too few for {}",
            options.people == 1 ? "one person is" : fmt::format("{} people are", options.people),
            laboratories == 1 ? "one laboratory" : fmt::format("{} laboratories", laboratories)),
        fmt::format("Rehearse at least two people of each: --people {}.", 2 * laboratories));
}

/// Reads and checks all files, and claims the folder. Returns the experiment's title and the
/// request.
std::pair<std::string, Asked> prepare(RehearseOptions& options, const Shard& shard) {
    options.request.simulate = true;
    options.request.participant = person_id(1);
    const session::Plan plan = session::make_plan(options.request);
    if (!plan.task) {
        throw Error({options.request.file, 0}, "task", "has no trials for people",
                    "Rehearse an experiment with 'task:', or see dihaptic run.");
    }
    print(plan.warnings);
    print(person::simulated_limits(*plan.task));
    options.population = population_of(options);
    check_laboratories(options);
    if (options.out.empty()) options.out = usual_folder(options.request);
    session::Rehearsal rehearsal = session::rehearsal_of(plan, write_fields(*options.population));
    rehearsal.asked = {options.people, shard.of, command_again(options)};
    session::claim(options.out, rehearsal);
    return {plan.title, rehearsal.asked};
}

std::string to_do(const Roster& roster) {
    if (roster.there == 0)
        return counted(static_cast<int64_t>(roster.waiting.size()), "session") + " to do";
    return fmt::format("{} to do, {} done before", roster.waiting.size(), roster.there);
}

void print_next(const RehearseOptions& options, const Shard& shard) {
    if (exit_code == kOk) {
        const bool all = shard.of == 1;
        fmt::print("complete: {}{}\nnext{}: dihaptic collect {}\n", options.out,
                   all ? "" : fmt::format(", shard {}/{}", shard.number, shard.of),
                   all ? "" : ", when the other shards are complete", shell_file(options.out));
    } else {
        fmt::print(
            "some people are still missing from {}: "
            "run the same command again to continue with them\n",
            options.out);
    }
}

void check_container(const RehearseOptions& options) {
    if (options.slurm == 0) {
        throw Error({"--container", 0}, "", "is valid only with --slurm",
                    "Add --slurm, or put apptainer exec and the file before dihaptic.");
    }
    std::error_code unreadable;
    if (!fs::is_regular_file(options.container, unreadable)) {
        throw Error({"--container", 0}, options.container, "is not a file",
                    "Make one with: apptainer build dihaptic.sif oci-archive:dihaptic.tar");
    }
}

/// Submits the shards with missing people to Slurm.
void rehearse_by_slurm(RehearseOptions& options) {
    if (options.slurm > options.people) {
        throw Error({"--slurm", 0}, "",
                    fmt::format("requests {} shards for {} people", options.slurm, options.people),
                    fmt::format("Request at most as many shards as there are people: --slurm {}.",
                                options.people));
    }
    const auto [title, asked] = prepare(options, {1, options.slurm});
    const Roster roster = roster_of(options, {});
    fmt::print("{}\n{}\n", title, to_do(roster));
    if (roster.waiting.empty()) {
        print_next(options, {});
        return;
    }
    std::vector<int> shards;
    for (int shard = 1; shard <= asked.shards; ++shard) {
        if (!roster_of(options, {shard, asked.shards}).waiting.empty()) shards.push_back(shard);
    }
    write_slurm_script(options.out, asked);
    const auto job = submit(options.out, asked, shards);
    if (!job) return;
    fmt::print(
        "submitted: job {}, an array of {} ({})\n"
        "watch it: squeue --job {}; messages of the shards: {}/slurm\n"
        "next, when it has ended: dihaptic collect {}\n",
        *job, counted(static_cast<int64_t>(shards.size()), "shard"), slurm_script(options.out),
        *job, options.out, shell_file(options.out));
}

/// Rehearses the file as a study. Returns false if the file is not a study.
bool rehearse_as_study(const RehearseOptions& options, const CLI::App& command) {
    if (task::kind_of(options.request.file) != task::FileKind::study) return false;
    for (const char* option : {"--shard", "--slurm", "--container"}) {
        if (command.count(option) > 0)
            throw Error({option, 0}, "", "is not possible for a study", "Use --jobs.");
    }
    StudyRehearsal study;
    study.file = options.request.file;
    study.out = options.out;
    if (command.count("--people") > 0) study.people = options.people;
    study.jobs = options.jobs;
    study.seed = options.request.seed;
    study.keep_recordings = options.keep_recordings;
    study.population = population_of(options);
    rehearse_study(study);
    return true;
}

void rehearse(RehearseOptions& options) {
    const Shard shard = parse_shard(options.shard);
    const std::string title = prepare(options, shard).first;
    const Roster roster = roster_of(options, shard);
    fmt::print("{}\n{}\n", title, to_do(roster));
    for (const std::string& text : run_crowd(work_of(options), roster.waiting))
        fmt::print(stderr, "{}\n", text);
    print_next(options, shard);
}

constexpr const char* kFooter =
    "\nA folder holds one experiment, one seed and one population; a rehearsal with another is "
    "refused.\nPeople who are complete are not repeated: after an interruption, the same command "
    "continues.\nResults are identical, byte for byte, with any --jobs, --shard and "
    "--slurm.\n--slurm "
    "checks all files, then writes slurm.sh into the folder and submits it with sbatch. "
    "collect\nlists the shards with missing people, and the command that completes "
    "them.\n\nExamples:\n  dihaptic rehearse experiments/visuomotor-rotation.yaml --people 40 "
    "--jobs 2\n  dihaptic rehearse experiments/rotation-reversal.yaml --population patients.yaml "
    "--people 40 --out patients\n  parallel dihaptic rehearse experiments/visuomotor-rotation.yaml "
    "--people 40 --shard {}/4 ::: 1 2 3 4\n  dihaptic rehearse "
    "experiments/visuomotor-rotation.yaml --people 40 --slurm 8\n  dihaptic rehearse my-study.yaml "
    "--jobs 2\n  dihaptic collect "
    "rehearsals/visuomotor-rotation_1";

}  // namespace

void add_rehearse(CLI::App& app) {
    auto* command =
        app.add_subcommand("rehearse", "Let a population of simulated people do an experiment");
    auto options = std::make_shared<RehearseOptions>();
    command->add_option("FILE", options->request.file, "experiment with trials, or study")
        ->transform(given_or_kept())
        ->required();
    command
        ->add_option("--population", options->population_file,
                     "population file from which people are drawn; default: the program's own, as "
                     "in populations/adults.yaml")
        ->transform(given_or_kept());
    command
        ->add_option(
            "--people", options->people,
            "number of people, named sim-001 and so on; default for a study: as many as it asks "
            "for")
        ->check(CLI::Range(1, session::kMostPeople))
        ->capture_default_str();
    command
        ->add_option("--laboratories", options->laboratories,
                     "number of laboratories from which the people come in turn, whose medians "
                     "differ as the population says; default: all come from a median one")
        ->check(CLI::Range(1, person::kMostLaboratories));
    command->add_option("--jobs", options->jobs, "number of sessions at a time")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command
        ->add_option("--shard", options->shard,
                     "only a part of the people, e.g. 3/20: every 20th person, from the 3rd")
        ->capture_default_str();
    command
        ->add_option("--slurm", options->slurm,
                     "submit this many shards to the cluster, as a Slurm array: see below")
        ->check(CLI::Range(1, session::kMostPeople));
    command->add_option("--container", options->container,
                        "with --slurm: Apptainer file (SIF) whose dihaptic runs the shards");
    command->add_option("--out", options->out, "folder; default: rehearsals/EXPERIMENT_SEED");
    command->add_option("--seed", options->request.seed, "seed of all random numbers")
        ->check(seed_range())
        ->capture_default_str();
    command
        ->add_flag("--real-objects", options->real_objects,
                   "people grip as they would without a device, as in "
                   "populations/adults-real-objects.yaml")
        ->excludes("--population");
    command->add_flag("--keep-recordings", options->keep_recordings,
                      "keep raw.log and session.nwb of each person: hundreds of MB");
    command->footer(kFooter);
    command->callback([options, command] {
        if (rehearse_as_study(*options, *command)) return;
        if (command->count("--container") > 0) check_container(*options);
        if (options->slurm == 0) return rehearse(*options);
        if (command->count("--shard") + command->count("--jobs") > 0) {
            throw Error({"--slurm", 0}, "", "cannot be combined with --shard or --jobs",
                        "Leave them out: Slurm runs all shards, each on one processor.");
        }
        rehearse_by_slurm(*options);
    });
}

}  // namespace dihaptic::cli
