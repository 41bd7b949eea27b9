#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>

#include "base/plural.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "command.h"
#include "person/simulated_limits.h"
#include "rehearsal.h"
#include "summary.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct RehearseOptions {
    session::Request request;
    std::string out;
    std::string shard = "1/1";
    std::string population_file;
    std::optional<person::Population> population;
    int people = 1;
    int jobs = 1;
    bool real_objects = false;
    bool keep_recordings = false;
};

struct Shard {
    int number = 1;  ///< from 1
    int of = 1;      ///< number of shards
};

Shard parse_shard(const std::string& text) {
    Shard shard;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%d/%d%c", &shard.number, &shard.of, &rest) != 2 ||
        shard.number < 1 || shard.number > shard.of) {
        throw Error({"--shard", 0}, text, "is no part of a whole",
                    "Write e.g. --shard 3/20: the third of twenty parts.");
    }
    return shard;
}

std::string id_of(int person) {
    return fmt::format("sim-{:03d}", person);
}
/// Folder in which a person's session is made, and then the folder of the complete session.
std::string unfinished(const RehearseOptions& options, const std::string& id) {
    return options.out + "/" + kUnfinished + id;
}
std::string finished(const RehearseOptions& options, const std::string& id) {
    return options.out + "/" + id;
}

/// Runs one person's session in a process of its own, so that others go on if it fails. Returns the
/// exit status of the process.
int run_person(const RehearseOptions& options, const std::string& id) {
    const std::string folder = unfinished(options, id);
    const int messages = open((folder + "/messages.txt").c_str(), O_CREAT | O_WRONLY, 0644);
    if (messages >= 0) {
        dup2(messages, STDOUT_FILENO);
        dup2(messages, STDERR_FILENO);
    }
    try {
        session::Request request = options.request;
        request.participant = id;
        request.order_number = options.population->number_in_group(id);
        session::Plan plan = session::make_plan(request);
        session::sit_down(plan, person::draw_person(*options.population, plan.seed, id));
        session::RunOptions run;
        run.out = folder;
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
        fs::rename(session.folder, finished(options, id));  // appears complete, or not at all
        fs::remove_all(folder);
        return kOk;
    } catch (const std::exception& e) {
        fmt::print("{}\n", e.what());
        std::fflush(stdout);
        return kFailed;
    }
}

/// Starts a person's process.
pid_t start(const RehearseOptions& options, const std::string& id) {
    fs::remove_all(unfinished(options, id));
    fs::create_directories(unfinished(options, id));
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int code = run_person(options, id);
        std::fflush(nullptr);
        _exit(code);
    }
    if (child < 0) {
        throw Error(fmt::format("cannot start another process: {}", std::strerror(errno)),
                    "Ask for fewer --jobs.");
    }
    return child;
}

std::string what_became(int status) {
    if (WIFSIGNALED(status)) return fmt::format("killed by signal {}", WTERMSIG(status));
    return stop_requested ? "interrupted" : "failed";
}

/// The messages of a person's process. If the disk is full there are none.
std::string messages_of(const RehearseOptions& options, const std::string& id) {
    const std::string messages = read_text_file(unfinished(options, id) + "/messages.txt");
    if (!messages.empty() || stop_requested) return messages;
    return fmt::format("It left no message: look whether the disk is full (df -h {}).",
                       options.out);
}

std::string usual_folder(const session::Request& request) {
    return fmt::format("rehearsals/{}_{}", fs::path(request.file).stem().string(), request.seed);
}

/// A shard's people.
struct Roster {
    std::vector<std::string> waiting;
    int there = 0;  ///< number of people whose sessions were complete before
};

Roster roster_of(const RehearseOptions& options, const Shard& shard) {
    Roster roster;
    for (int person = shard.number; person <= options.people; person += shard.of) {
        if (fs::exists(finished(options, id_of(person)))) {
            ++roster.there;
        } else {
            roster.waiting.push_back(id_of(person));
        }
    }
    return roster;
}

/// Rehearses people. Returns what to print about those whose sessions failed.
std::vector<std::string> run_people(const RehearseOptions& options,
                                    const std::vector<std::string>& people) {
    ProgressLine line("rehearsing");
    std::map<pid_t, std::string> running;
    std::vector<std::string> failed;
    const size_t all = people.size();
    size_t next = 0;
    size_t done = 0;
    while (!running.empty() || (next < all && !stop_requested)) {
        while (static_cast<int>(running.size()) < options.jobs && next < all && !stop_requested) {
            const std::string& id = people[next++];
            running[start(options, id)] = id;
        }
        int status = 0;
        const pid_t child = waitpid(-1, &status, 0);
        if (child < 0 && errno == EINTR) continue;
        if (child < 0)
            throw Error({options.out, 0}, "",
                        "is not watched over: " + std::string(std::strerror(errno)),
                        "Start it again: it goes on with those that are missing.");
        const auto ended = running.find(child);
        if (ended == running.end()) continue;
        if (status != 0) {
            failed.push_back(fmt::format("{}: {}. {}", ended->second, what_became(status),
                                         messages_of(options, ended->second)));
        } else {
            ++done;
        }
        running.erase(ended);
        line.show(static_cast<double>(done + failed.size()) / static_cast<double>(all),
                  fmt::format("{} of {}", done, all));
    }
    if (done < all) exit_code = kFailed;
    return failed;
}

void rehearse(RehearseOptions& options) {
    const Shard shard = parse_shard(options.shard);
    options.request.simulate = true;
    options.request.participant = id_of(1);
    const session::Plan plan = session::make_plan(options.request);
    if (!plan.task) {
        throw Error({options.request.file, 0}, "task", "has no trials that people could do",
                    "Rehearse an experiment with 'task:', or see dihaptic run.");
    }
    print(plan.warnings);
    print(person::simulated_limits(*plan.task));
    options.population = population_of(options.population_file, options.real_objects);
    if (options.out.empty()) options.out = usual_folder(options.request);
    claim(options.out, rehearsal_of(plan, *options.population));

    const auto [waiting, there] = roster_of(options, shard);
    fmt::print("{}\n{}\n", plan.title,
               there == 0 ? fmt::format("{} to do",
                                        counted(static_cast<int64_t>(waiting.size()), "session"))
                          : fmt::format("{} to do, {} done before", waiting.size(), there));
    for (const std::string& text : run_people(options, waiting)) fmt::print(stderr, "{}\n", text);
    if (exit_code == kOk) {
        fmt::print("complete: {}\nnext: dihaptic collect {}\n", options.out, options.out);
    } else {
        fmt::print("some are missing in {}: the same command goes on with those\n", options.out);
    }
}

}  // namespace

void add_rehearse(CLI::App& app) {
    auto* command =
        app.add_subcommand("rehearse", "Let a population of simulated people do an experiment");
    auto options = std::make_shared<RehearseOptions>();
    command->add_option("FILE", options->request.file, "experiment with trials")
        ->transform(given_or_kept())
        ->required();
    command
        ->add_option("--population", options->population_file,
                     "population file that people are drawn from; default: the program's own, "
                     "as in populations/adults.yaml")
        ->transform(given_or_kept());
    command->add_option("--people", options->people, "how many, sim-001 and so on")
        ->check(CLI::Range(1, 9999))
        ->capture_default_str();
    command->add_option("--jobs", options->jobs, "sessions at a time")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_option("--shard", options->shard, "only every 20th person, from the 3rd: 3/20")
        ->capture_default_str();
    command->add_option("--out", options->out, "folder; default: rehearsals/EXPERIMENT_SEED");
    command->add_option("--seed", options->request.seed, "of everything random")
        ->check(seed_range())
        ->capture_default_str();
    command
        ->add_flag("--real-objects", options->real_objects,
                   "people grip as one does without a device between: as in "
                   "populations/adults-real-objects.yaml")
        ->excludes("--population");
    command->add_flag("--keep-recordings", options->keep_recordings,
                      "keep raw.log and session.nwb of each: hundreds of MB");
    command->footer(
        "\nA folder holds one experiment, seed and population: into another one it refuses to go.\n"
        "Who is there already is not done again: after a break the same command goes on.\n"
        "Results are the same to the byte whatever --jobs and --shard.\n"
        "\nExamples:\n"
        "  dihaptic rehearse experiments/visuomotor-rotation.yaml --people 40 --jobs 2\n"
        "  dihaptic rehearse experiments/rotation-reversal.yaml --population patients.yaml "
        "--people "
        "40 --out patients\n"
        "  parallel dihaptic rehearse experiments/visuomotor-rotation.yaml --people 40 --shard "
        "{}/4 ::: 1 2 3 4\n"
        "  dihaptic collect rehearsals/visuomotor-rotation_1");
    command->callback([options] { rehearse(*options); });
}

}  // namespace dihaptic::cli
