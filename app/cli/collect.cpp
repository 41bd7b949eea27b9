#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "base/plural.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "base/text_file.h"
#include "command.h"
#include "recording/moved_by.h"
#include "recording/session.h"
#include "rehearse_command.h"
#include "session/rehearsal.h"
#include "session/rehearsed.h"
#include "session/unfinished_folder.h"
#include "session_tables.h"
#include "shards.h"
#include "study_collection.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;
using session::Asked;
using session::kUnfinished;
using session::person_id;
using session::Rehearsal;

struct CollectOptions {
    std::vector<std::string> folders;
    std::string out;
    bool join_seeds = false;
};

struct Key {
    std::string seed;
    std::string id;
    auto operator<=>(const Key&) const = default;
};

/// Throws Error unless a folder belongs to the same rehearsal as the first folder or, with
/// --join-seeds, to a rehearsal that differs only in its seed.
void check_same(const CollectOptions& options, const std::string& first_folder,
                const Rehearsal& first, const std::string& folder, const Rehearsal& other) {
    Rehearsal same_seed = other;
    if (options.join_seeds) same_seed.seed = first.seed;
    const std::string what = session::difference(first, same_seed);
    if (what.empty()) return;
    const bool seeds = first.seed != other.seed && !options.join_seeds;
    throw Error({folder, 0}, "",
                fmt::format("is a different rehearsal from {}: {}", first_folder, what),
                seeds ? "To join several seeds, add --join-seeds."
                      : "Collect sessions of one experiment and one version only.");
}

/// The most recently requested rehearsal, whose command asked for the most people, and its folder.
struct Wanted {
    std::string folder;
    Rehearsal rehearsal;
};

struct Found {
    std::map<Key, std::string> people;      ///< folder of each person's session
    std::map<Key, std::string> unfinished;  ///< folder of each unfinished session
    std::map<std::string, Wanted> wanted;   ///< by seed
    std::vector<std::string>
        others;  ///< folders of sessions that do not belong to a person of the rehearsal
    std::vector<Problem> problems;                  ///< problems found in people's folders
    std::map<std::string, std::string> identities;  ///< maps a session's identity to its folder
    std::vector<std::string> unsealed;              ///< folders of sessions that have no seal
};

/// The contents of a rehearsal folder.
struct Content {
    std::vector<std::string> people;      ///< their identifiers
    std::vector<std::string> unfinished;  ///< identifiers of people whose sessions are unfinished
    std::vector<std::string> others;  ///< names of folders with sessions that belong to no person
};

/// Whether a folder's name has the form of a person's identifier, e.g. "sim-003".
bool is_persons(const std::string& name) {
    const std::string first = person_id(1);
    const std::string_view stem = std::string_view(first).substr(0, first.find('-') + 1);
    return name.size() > stem.size() && name.starts_with(stem) &&
           name.find_first_not_of("0123456789", stem.size()) == std::string::npos;
}

Content content_of(const std::string& folder) {
    Content out;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        std::error_code unreadable;
        if (!fs::is_directory(entry.path(), unreadable)) continue;
        if (name.starts_with(kUnfinished)) {
            out.unfinished.push_back(name.substr(std::string_view(kUnfinished).size()));
        } else if (is_persons(name) || is_there((entry.path() / "person.yaml").string())) {
            out.people.push_back(name);
        } else if (is_there((entry.path() / "session.yaml").string())) {
            out.others.push_back(name);
        }
    }
    for (auto* names : {&out.people, &out.unfinished, &out.others}) std::ranges::sort(*names);
    return out;
}

/// Adds a person, and the problems found in the person's folder. Throws Error when a person appears
/// twice.
void add_person(Found& found, const std::string& folder, const std::string& id,
                const Rehearsal& rehearsal) {
    const std::string session = folder + "/" + id;
    const auto [there, is_new] = found.people.emplace(Key{rehearsal.seed, id}, session);
    if (!is_new) {
        throw Error({session, 0}, "", "appears twice: " + there->second,
                    "Name folders of different shards or different seeds.");
    }
    const session::Rehearsed looked = session::look_at(folder, id, rehearsal);
    found.problems.insert(found.problems.end(), looked.problems.begin(), looked.problems.end());
    if (looked.identity.empty()) return;
    if (!looked.sealed) found.unsealed.push_back(session);
    const auto [first, is_first] = found.identities.emplace(looked.identity, session);
    if (is_first) return;
    found.problems.push_back({Severity::error,
                              {session, 0},
                              "",
                              "has the same session as " + first->second,
                              "Remove the copy."});
}

Found find_people(const CollectOptions& options) {
    Found found;
    std::optional<Rehearsal> first;
    std::string first_folder;
    for (const std::string& folder : options.folders) {
        std::error_code unreadable;
        if (!fs::is_directory(folder, unreadable)) {
            throw Error({folder, 0}, "", "is not a folder",
                        "Name the folders made by dihaptic rehearse.");
        }
        const Content content = content_of(folder);
        if (content.people.empty() && !is_there(folder + "/rehearsal.yaml")) continue;
        const Rehearsal rehearsal = session::read_rehearsal(folder);
        for (const std::string& id : content.unfinished)
            found.unfinished[{rehearsal.seed, id}] = folder + "/" + kUnfinished + id;
        for (const std::string& name : content.others) found.others.push_back(folder + "/" + name);
        Wanted& wanted = found.wanted[rehearsal.seed];
        if (wanted.rehearsal.asked.people < rehearsal.asked.people) wanted = {folder, rehearsal};
        if (!first) {
            first = rehearsal;
            first_folder = folder;
        }
        check_same(options, first_folder, *first, folder, rehearsal);
        for (const std::string& id : content.people) add_person(found, folder, id, rehearsal);
    }
    if (found.wanted.empty()) {
        throw Error({options.folders.front(), 0}, "", "is not the folder of a rehearsal",
                    "Rehearse first: dihaptic rehearse --help.");
    }
    return found;
}

/// Throws Error with all faults found in people's folders, because a table that lacked a person, or
/// listed a person twice, would look like any other. Reports what cannot be checked in folders
/// written by older versions.
void check_whole(Found& found) {
    if (!found.unsealed.empty() && found.unsealed.size() < found.identities.size()) {
        for (const std::string& session : found.unsealed) {
            found.problems.push_back(
                {Severity::error,
                 {session + "/session.yaml", 0},
                 "seal",
                 "is missing, although other sessions of this rehearsal have one",
                 "Restore the folder, or remove it: the rehearsal's command "
                 "then repeats this person."});
        }
    }
    if (!found.problems.empty()) throw Error(found.problems);
    if (found.unsealed.empty()) return;
    fmt::print(
        "note: {} no seal, because {} version made none: later changes to their tables cannot be "
        "noticed\n",
        found.unsealed.size() == 1 ? found.unsealed[0] + " has" : "these sessions have",
        found.unsealed.size() == 1 ? "its" : "their");
}

/// The missing people of a seed, grouped by shard.
std::map<int, std::vector<std::string>> missing_of(const Found& found, const std::string& seed,
                                                   const Asked& asked) {
    std::map<int, std::vector<std::string>> out;
    for (int n = 1; n <= asked.people; ++n) {
        if (!found.people.contains({seed, person_id(n)}))
            out[session::shard_of(n, asked.shards)].push_back(person_id(n));
    }
    return out;
}

/// Prints the command that runs the given shards of a rehearsal.
void print_command(const Wanted& wanted, const std::vector<int>& shards) {
    const auto command = command_of(wanted.folder, wanted.rehearsal);
    if (!command) {
        fmt::print(
            "to complete these, repeat the command that rehearsed them; the one in "
            "{}/rehearsal.yaml was not written by dihaptic\n",
            mended(wanted.folder, Lines::one));
        return;
    }
    Asked asked = wanted.rehearsal.asked;
    asked.command = *command;
    fmt::print("to complete these, once no other process is working on them: {}\n",
               command_for(wanted.folder, asked, shards));
}

/// Lists the people who are left out, and prints the command that runs the requested people.
void print_left_out(const Found& found) {
    auto others = found.unfinished;
    for (const auto& [seed, wanted] : found.wanted) {
        const Asked& asked = wanted.rehearsal.asked;
        const auto missing = missing_of(found, seed, asked);
        if (missing.empty()) continue;
        std::vector<int> shards;
        for (const auto& [shard, people] : missing) {
            std::string names;
            for (const std::string& id : people) {
                const bool begun = others.erase({seed, id}) > 0;
                names += (names.empty() ? "" : ", ") + id + (begun ? " (not ended)" : "");
            }
            fmt::print("missing: {}{}\n",
                       asked.shards == 1 ? "" : fmt::format("shard {}/{}: ", shard, asked.shards),
                       names);
            shards.push_back(shard);
        }
        print_command(wanted, shards);
        exit_code = kFailed;
    }
    for (const std::string& folder : found.others) {
        fmt::print(
            "left out: {}: it does not belong to a rehearsed person, and has no person.yaml\n",
            mended(folder, Lines::one));
    }
    for (const auto& [key, folder] : others) {
        fmt::print(
            "left out: {}: its session has not ended; the command that started it continues it\n",
            mended(folder, Lines::one));
    }
}

/// Collects how accurately the contacts of all sessions were solved.
class Contacts {
  public:
    void add(const recording::SessionInfo& info) {
        ++sessions_;
        if (!info.convergence) return;  // recorded only since version 0.3
        const recording::Convergence& one = *info.convergence;
        ++known_;
        ticks_ += one.ticks;
        missed_ += one.missed;
        missing_ += one.missed > 0;
        longest_run_ = std::max(longest_run_, one.longest_run);
        held_residual_ = std::max(held_residual_, one.held_residual.value_or(0));
    }
    std::string describe() const {
        if (known_ == 0) return "no session recorded how closely its contacts were solved";
        const std::string of = counted(known_, "session");
        std::string out =
            missed_ == 0
                ? fmt::format("the contact solver was within its tolerance in all {} of {}",
                              counted(ticks_, "tick"), of)
                : fmt::format(
                      "the contact solver missed its tolerance in {} of {}, in {} of {}, "
                      "in at most {} in a row",
                      missed_, counted(ticks_, "tick"), missing_, of, longest_run_);
        if (held_residual_ > 0)
            out +=
                fmt::format("; its largest residual at touched objects was {:.1g}", held_residual_);
        if (known_ < sessions_)
            out += fmt::format("; {} of {} did not record this", sessions_ - known_,
                               counted(sessions_, "session"));
        return out;
    }

  private:
    int64_t sessions_ = 0, known_ = 0, missing_ = 0, ticks_ = 0, missed_ = 0;
    int longest_run_ = 0;
    double held_residual_ = 0;
};

/// The collected tables. Each row starts with the seed, the group and the id, and ends with the
/// source of the hand's motion.
class Collection {
  public:
    explicit Collection(const std::map<Key, std::string>& people) {
        for (const auto& [key, session] : people) note_traits(read_yaml(session + "/person.yaml"));
    }

    void add(const Key& key, const std::string& session) {
        const Node person = read_yaml(session + "/person.yaml");
        const Node* group = person.find("group");
        front_ = {key.seed, group == nullptr ? "" : group->scalar, key.id};
        for (const TextTable& table : tables_of(session)) append(table);
        const recording::SessionInfo info =
            recording::SessionFolder::open_tables(session).read_info();
        append(text_of(recording::marked(person_table(person), info.moved_by), "people.csv"));
        contacts_.add(info);
    }

    /// Writes the tables into a folder and returns the names of the files.
    std::vector<std::string> write(const std::string& folder) const {
        std::vector<std::string> out;
        for (const auto& [name, table] : tables_) {
            write_file(to_csv(table), folder + "/" + name);
            out.push_back(name);
        }
        return out;
    }
    size_t rows(const std::string& name) const { return tables_.at(name).rows.size(); }
    const Contacts& contacts() const { return contacts_; }
    /// Says that no attempt at a trial was made, or that all were to be repeated; "" otherwise.
    /// `task`: task.yaml of a session.
    std::string without_trials(const Node& task) const {
        const TextTable& trials = tables_.at("trials.csv");
        if (trials.rows.empty())
            return "no trial was done: see whether the task's criteria (until, needs) hold from "
                   "the start";
        const auto column = std::ranges::find(trials.columns, "outcome", &Table::Column::name) -
                            trials.columns.begin();
        const std::set<std::string> repeated = repeated_outcomes(task);
        std::set<std::string> ended;
        for (const auto& row : trials.rows) ended.insert(row[static_cast<size_t>(column)]);
        if (!std::ranges::includes(repeated, ended)) return "";
        return fmt::format(
            "no attempt ended as a trial should: after {} the trial is repeated "
            "(redo)",
            fmt::join(ended, " and "));
    }

  private:
    static std::set<std::string> repeated_outcomes(const Node& task) {
        std::set<std::string> out;
        const Node none;
        const auto part = [&](const Node& of, const char* key) -> const Node& {
            const Node* found = of.find(key);
            return found == nullptr ? none : *found;
        };
        for (const Node& state : part(task, "states").items) {
            for (const Node& exit : part(state, "exits").items) {
                if (part(exit, "redo").scalar == "yes") out.insert(part(exit, "outcome").scalar);
            }
        }
        return out;
    }
    /// Adds a column for each of the person's traits, even if other people lack it: people defined
    /// in Python may belong to different classes.
    void note_traits(const Node& person) {
        for (const auto& entry : person.entries) {
            if (entry.key == "id" || entry.key == "group" || entry.key == "partner") continue;
            if (std::ranges::find(traits_, entry.key) == traits_.end())
                traits_.push_back(entry.key);
        }
    }
    Table person_table(const Node& person) const {
        Table out;
        out.rows.resize(1);
        for (const std::string& trait : traits_) {
            const Node* const value = person.find(trait);
            out.columns.push_back({trait, ""});
            out.rows[0].push_back(value == nullptr ? "" : value->scalar);
        }
        return out;
    }

    /// Appends a session's table. Throws Error when its header differs from that of an earlier
    /// table.
    void append(const TextTable& table) {
        TextTable& all = tables_[table.name];
        std::vector<Table::Column> header;
        for (const char* name : session::kCollectedColumns) header.push_back({name, ""});
        header.insert(header.end(), table.columns.begin(), table.columns.end());
        if (all.columns.empty()) all.columns = header;
        if (!std::ranges::equal(all.columns, header, {}, &Table::Column::name,
                                &Table::Column::name)) {
            throw Error({table.name, 1}, "",
                        fmt::format("of {} has different columns from earlier ones", front_[2]),
                        "Collect sessions of one experiment and one version only.");
        }
        for (const auto& cells : table.rows) {
            std::vector<std::string> row = front_;
            row.insert(row.end(), cells.begin(), cells.end());
            all.rows.push_back(std::move(row));
        }
    }

    std::vector<std::string> traits_;  // trait columns of people.csv
    std::vector<std::string> front_;
    std::map<std::string, TextTable> tables_;
    Contacts contacts_;
};

void collect(const CollectOptions& options) {
    Found found = find_people(options);
    print_left_out(found);
    std::fflush(stdout);
    check_whole(found);
    const auto& people = found.people;
    if (people.empty()) {
        fmt::print("no session is complete yet: nothing to collect\n");
        exit_code = kFailed;
        return;
    }
    Collection collection(people);
    {
        ProgressLine line("collecting");
        double done = 0;
        for (const auto& [key, session] : people) {
            collection.add(key, session);
            line.show_or_stop(++done / static_cast<double>(people.size()));
        }
    }
    const std::string out = options.out.empty() ? options.folders.front() : options.out;
    fs::create_directories(out);
    std::string names;
    for (const std::string& name : collection.write(out))
        names += (names.empty() ? "" : ", ") + name;
    fmt::print("{}, {}: in {}: {}\n", counted(static_cast<int64_t>(people.size()), "session"),
               counted(static_cast<int64_t>(collection.rows("trials.csv")), "attempt"), out, names);
    fmt::print("{}\n", collection.contacts().describe());
    const std::string task = people.begin()->second + "/task.yaml";
    const std::string nothing =
        collection.without_trials(is_there(task) ? read_yaml(task) : Node{});
    if (!nothing.empty()) fmt::print(stderr, "warning: {}\n", nothing);
}

}  // namespace

void add_collect(CLI::App& app) {
    auto* command = app.add_subcommand(
        "collect", "Join the tables of rehearsed people: trials, lifts, fits, traits");
    auto options = std::make_shared<CollectOptions>();
    auto study = std::make_shared<StudyData>();
    command
        ->add_option("FOLDER", options->folders, "folders of dihaptic rehearse, or a study's file")
        ->required();
    command->add_option("--out", options->out, "folder for the tables; default: the first one");
    command->add_flag(
        "--join-seeds", options->join_seeds,
        "folders may have different seeds; the column 'seed' tells their people apart");
    command->add_option("--rehearsed", study->rehearsed,
                        "with a study: the folder of its rehearsal, in place of its participants");
    command->add_flag("--reveal-groups", study->reveal_groups,
                      "with a study: show the names of concealed groups; this is logged");
    command->footer(
        "\nA study's tables go to tables/ next to participants.yaml, each row with the person's "
        "group,\n"
        "session and condition; participants.csv lists the people.\n"
        "\nExamples:\n"
        "  dihaptic collect my-study.yaml\n"
        "  dihaptic collect rehearsals/visuomotor-rotation_1\n"
        "  dihaptic collect rehearsals/visuomotor-rotation_* --join-seeds --out both");
    command->callback([options, study] {
        study->file = options->folders.front();
        if (!is_study(study->file)) return collect(*options);
        collect_study(*study, options->out);
    });
}

}  // namespace dihaptic::cli
