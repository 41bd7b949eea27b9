#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>

#include "base/plural.h"
#include "command.h"
#include "session/study_session.h"
#include "study/allocation.h"
#include "study/key_file.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct ParticipantOptions {
    std::string file;
    study::Member person;
    std::vector<std::string> facts;
    std::string reason;
    std::string key_file, name, contact;
    bool with_key = false;  // whether --key was given
    bool keep_data = false, delete_data = false;
};

std::string group_text(const study::StudyFile& study, const study::Member& member) {
    return study.allocation.concealed ? "concealed" : member.group;
}

/// Freezes the study's files when the first participant is added; for later participants, throws
/// Error if the files have changed.
void freeze_or_check(const study::StudyFile& study, const std::string& id) {
    session::StudyVersion now = session::present_version(study);
    session::check_unchanged(study, now);
    if (!session::versions_of(study).empty()) return;
    study::log(study, "version", id, "1: first participant");
    session::freeze(study, std::move(now), "first participant");
    fmt::print("the study's files are frozen as version 1: later changes have to be accepted\n");
}

void read_facts(ParticipantOptions& options) {
    for (const std::string& text : options.facts) {
        const size_t equals = text.find('=');
        if (equals == std::string::npos)
            throw Error({"--fact", 0}, text, "has no value", "Write --fact NAME=VALUE.");
        options.person.facts.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
}

/// The file with participants' names; nullopt if none was given.
std::optional<study::KeyFile> names_of(const ParticipantOptions& options,
                                       const study::StudyFile& study,
                                       study::KeyFile::Missing missing) {
    if (!options.with_key) return {};
    return study::KeyFile(study, options.key_file, missing);
}

void add(ParticipantOptions& options) {
    Diagnostics diagnostics;
    const study::StudyFile study = session::checked_study(options.file, diagnostics);
    diagnostics.throw_if_errors();
    read_facts(options);
    study::Member& person = options.person;
    const study::StudyLock lock(study);
    study::Roster roster = study::read_roster(study);
    if (roster.find(person.id) != nullptr) {
        throw Error({"participant", 0}, person.id, "has been added already",
                    "Each participant has an identifier of their own.");
    }
    const std::vector<std::string> against = study::reasons_against(study, person);
    if (!against.empty()) {
        fmt::print("{} cannot take part: {}\n", person.id, fmt::join(against, "; "));
        study::log(study, "not included", person.id, fmt::format("{}", fmt::join(against, "; ")));
        exit_code = kFailed;
        return;
    }
    std::optional<study::KeyFile> names =
        names_of(options, study, study::KeyFile::Missing::is_made);
    if (names && options.name.find_first_not_of(' ') == std::string::npos)
        throw Error({"--name", 0}, "", "is empty", "Give the participant's name.");
    if (names && names->find(person.id) != nullptr) {
        throw Error({options.key_file, 0}, person.id, "already belongs to a name",
                    "Choose another identifier, or correct the file.");
    }
    freeze_or_check(study, person.id);
    const study::Allocated allocated = study::allocate(study, roster, person);
    person.group = allocated.group;
    person.number = allocated.number;
    person.added = recording::iso_now();
    person.version = static_cast<int>(session::versions_of(study).size());
    roster.participants.push_back(person);
    // names come first: if the name cannot be written, no participant is added
    if (names) names->add({person.id, options.name, options.contact});
    study::log(study, "add", person.id, study.shown_group(person.group));
    study::write_roster(study, roster);
    int active = 0;
    for (const study::Group& group : study.groups) active += roster.active(group.name);
    fmt::print("{} added{}: {} of {} participants\n", person.id,
               study.allocation.concealed
                   ? " (group concealed)"
                   : fmt::format(", group {}, number {}", person.group, person.number),
               active, study.people());
}

study::Next next_of(const study::StudyFile& study, const study::Member& member) {
    return study::next_for(study, session::visits_of(study, member),
                           study::seconds_of(recording::iso_now()));
}

/// The state of a participant in a few words.
std::string state_of(const study::StudyFile& study, const study::Member& member) {
    if (!member.takes_part())
        return fmt::format("withdrew {}{}", member.withdrawn.substr(0, 10),
                           member.data_deleted ? ", data deleted" : "");
    const study::Next next = next_of(study, member);
    if (next.act == study::Act::none) return "all sessions complete";
    const std::string& name = study.sessions[next.session].name;
    if (next.act == study::Act::resume && !next.against.empty())
        return fmt::format("{} is running", name);
    if (next.act == study::Act::resume) return fmt::format("{} is to be resumed", name);
    return fmt::format("next: {}{}", name, next.against.empty() ? "" : ", not now");
}

/// The participant's state, or the reason why it cannot be determined: a damaged recording does not
/// hide the other participants.
std::string state_or_fault(const study::StudyFile& study, const study::Member& member) {
    try {
        return state_of(study, member);
    } catch (const Error& e) {
        exit_code = kFailed;
        return e.what();
    }
}

void list(const ParticipantOptions& options) {
    const study::StudyFile study = study::read_study(options.file);
    const study::Roster roster = study::read_roster(study);
    fmt::print("{}\n", study.title);
    size_t width = 4;
    for (const study::Group& group : study.groups) width = std::max(width, group.name.size());
    for (const study::Member& member : roster.participants) {
        fmt::print("  {:12s} {:{}s}  {}\n", member.id, group_text(study, member),
                   std::max<size_t>(width, study.allocation.concealed ? 9 : 0),
                   state_or_fault(study, member));
    }
    int active = 0;
    for (const study::Group& group : study.groups) {
        active += roster.active(group.name);
        if (!study.allocation.concealed)
            fmt::print("group {:{}s}  {} of {}\n", group.name, width, roster.active(group.name),
                       group.people);
    }
    fmt::print("{} of {} participants\n", active, study.people());
}

const study::Member& known(const study::Roster& roster, const std::string& id) {
    const study::Member* member = roster.find(id);
    if (member == nullptr) {
        throw Error({"participant", 0}, id, "has not been added to this study",
                    "dihaptic participant list shows who has been.");
    }
    return *member;
}

void show(const ParticipantOptions& options) {
    const study::StudyFile study = study::read_study(options.file);
    const study::Roster roster = study::read_roster(study);
    const study::Member& member = known(roster, options.person.id);
    const auto line = [](const std::string& name, const std::string& value) {
        if (!value.empty()) fmt::print("  {:14s} {}\n", name, value);
    };
    fmt::print("{}\n", member.id);
    if (const auto names = names_of(options, study, study::KeyFile::Missing::is_refused)) {
        const study::Key* const key = names->find(member.id);
        line("name", key == nullptr ? "not in the key file" : key->name);
        line("contact", key == nullptr ? "" : key->contact);
    }
    line("group", group_text(study, member));
    if (!study.allocation.concealed) {
        line("number", fmt::format("{}", member.number));
        line("conditions",
             fmt::format("{}", fmt::join(study.conditions_of(member.group, member.number), ", ")));
    }
    line("age", member.age);
    line("sex", member.sex);
    line("handedness", member.handedness);
    for (const recording::Fact& fact : member.facts) line(fact.name, fact.value);
    line("added", fmt::format("{}, version {} of the files", member.added, member.version));
    line("withdrawn", member.withdrawn);
    line("reason", member.reason);
    for (const study::Visit& visit : session::visits_of(study, member)) {
        line(study.sessions[visit.session].name,
             fmt::format("{} {}",
                         visit.complete ? "complete"
                                        : fmt::format("{} of {} trials", visit.done, visit.trials),
                         visit.folder));
    }
    line("state", state_of(study, member));
    if (!member.takes_part()) return;
    for (const std::string& why : next_of(study, member).against) line("", why);
}

/// Deletes the participant's name from the file of names. Returns whether the file contained it.
bool delete_name(const ParticipantOptions& options, const study::StudyFile& study) {
    std::optional<study::KeyFile> names =
        names_of(options, study, study::KeyFile::Missing::is_refused);
    if (!names || !names->remove(options.person.id)) return false;
    fmt::print("{}: the name is deleted\n", options.person.id);
    return true;
}

/// Deletes the folder of a participant who has withdrawn.
void delete_recordings(const std::string& folder) {
    std::error_code failed;
    const auto deleted = fs::remove_all(folder, failed);
    if (failed) {
        throw Error({folder, 0}, "", "cannot be deleted: " + failed.message(),
                    "The withdrawal is noted. Delete this folder yourself.");
    }
    fmt::print("{}: {} deleted\n", folder, counted(static_cast<int64_t>(deleted), "file"));
}

void withdraw(const ParticipantOptions& options) {
    const study::StudyFile study = study::read_study(options.file);
    const study::StudyLock lock(study);
    study::Roster roster = study::read_roster(study);
    known(roster, options.person.id);
    study::Member& member =
        *std::ranges::find(roster.participants, options.person.id, &study::Member::id);
    const bool had_name = delete_name(options, study);
    if (!member.takes_part() && had_name && !options.delete_data) return;
    if (!member.takes_part() && (member.data_deleted || !options.delete_data)) {
        throw Error({"participant", 0}, member.id, fmt::format("withdrew on {}", member.withdrawn),
                    "There is nothing left to do.");
    }
    const auto recordings = options.delete_data ? session::deletable(study, member) : "";
    study::log(study, "withdraw", member.id,
               fmt::format("data {}{}{}", options.delete_data ? "deleted" : "kept",
                           options.reason.empty() ? "" : "; ", options.reason));
    const bool took_part = member.takes_part();
    if (took_part) member.withdrawn = recording::iso_now();
    if (!options.reason.empty()) member.reason = options.reason;
    member.data_deleted = options.delete_data;
    study::write_roster(study, roster);
    if (!recordings.empty()) delete_recordings(recordings);
    fmt::print("{} withdrew{}\n", member.id,
               took_part ? "; the place in the group is free for another participant" : "");
}

void accept(const ParticipantOptions& options) {
    Diagnostics diagnostics;
    const study::StudyFile study = session::checked_study(options.file, diagnostics);
    diagnostics.throw_if_errors();
    const study::StudyLock lock(study);
    const study::Roster roster = study::read_roster(study);  // checks that all groups exist
    session::StudyVersion now = session::present_version(study);
    const auto versions = session::versions_of(study);
    if (versions.empty()) session::check_unchanged(study, now);  // versions lost, or none yet
    const std::string what = versions.empty() ? "" : session::changed(versions.back(), now);
    if (what.empty()) {
        throw Error({options.file, 0}, "",
                    versions.empty() ? "has no version yet: nobody has been added"
                                     : "has not changed since its last version",
                    "There is nothing left to do.");
    }
    study::log(study, "version", "",
               fmt::format("{}: {}; {}", versions.size() + 1, options.reason, what));
    const int number = session::freeze(study, std::move(now), options.reason);
    fmt::print("version {} of the study's files, for the sessions from now on\nfirst change: {}\n",
               number, what);
    for (const study::Member& member : roster.participants) {
        for (const std::string& folder : session::uncounted(study, member))
            fmt::print(stderr,
                       "WARNING: {} is no longer part of the study, which has no session with "
                       "this name\n",
                       folder);
    }
}

using Shared = std::shared_ptr<ParticipantOptions>;

/// Adds the option --key. `what`: what happens to the names, for the option's help text.
CLI::Option* add_key(CLI::App& command, const Shared& options, const char* what) {
    return command
        .add_option("--key", options->key_file,
                    std::string("file of names, outside the study's folder: ") + what)
        ->each([options](const std::string&) { options->with_key = true; });
}

CLI::App* add_action(CLI::App& parent, const Shared& options, const char* name, const char* what,
                     const char* example, bool one_person) {
    auto* command = parent.add_subcommand(name, what);
    command->add_option("STUDY", options->file, "study file")->required()->check(CLI::ExistingFile);
    if (one_person)
        command->add_option("ID", options->person.id, "the participant's identifier, e.g. S07")
            ->required();
    command->footer(fmt::format("\nExample:\n  dihaptic participant {} {}", name, example));
    return command;
}

void add_adding(CLI::App& parent, const Shared& options) {
    auto* command = add_action(parent, options, "add", "Add a participant, and allocate a group",
                               "my-study.yaml S07 --age 24 --sex F --handedness right", true);
    command->add_option("--age", options->person.age, "age in years");
    command->add_option("--sex", options->person.sex, "F, M, O, or U: not stated")
        ->check(CLI::IsMember({"F", "M", "O", "U"}));
    command->add_option("--handedness", options->person.handedness, "right, left or both")
        ->check(CLI::IsMember({"right", "left", "both"}));
    command->add_option("--fact", options->facts,
                        "a fact that the study asks for, NAME=VALUE; may be repeated");
    auto* key = add_key(*command, options, "the name is added to this file");
    auto* name = command->add_option("--name", options->name, "name, written only to the key file");
    command->add_option("--contact", options->contact, "contact, written only to the key file")
        ->needs(name);
    name->needs(key);
    key->needs(name);
    command->callback([options] { add(*options); });
}

void add_withdrawing(CLI::App& parent, const Shared& options) {
    auto* command =
        add_action(parent, options, "withdraw", "Note that a participant withdrew",
                   "my-study.yaml S07 --keep-data --reason \"did not come back\"", true);
    auto* data = command->add_option_group("data", "what happens to the participant's recordings");
    data->add_flag("--keep-data", options->keep_data, "recordings stay");
    data->add_flag("--delete-data", options->delete_data, "recordings are deleted permanently");
    data->require_option(1);
    command->add_option("--reason", options->reason, "reason, for the log");
    add_key(*command, options, "the name is deleted from this file");
    command->callback([options] { withdraw(*options); });
}

}  // namespace

void add_participant(CLI::App& app) {
    auto* command = app.add_subcommand(
        "participant", "Add, list, show and withdraw a study's participants; accept changed files");
    command->require_subcommand(1);
    command->footer(
        "\nExamples:\n  dihaptic participant add my-study.yaml S07 --age 24\n  dihaptic "
        "participant list my-study.yaml\n\nThen: dihaptic run my-study.yaml --participant S07");
    const auto options = std::make_shared<ParticipantOptions>();
    add_adding(*command, options);
    add_action(*command, options, "list", "List participants, groups, and what comes next",
               "my-study.yaml", false)
        ->callback([options] { list(*options); });
    auto* showing = add_action(*command, options, "show", "Show one participant",
                               "my-study.yaml S07 --key ~/names/my-study.csv", true);
    add_key(*showing, options, "the name in this file is shown too");
    showing->callback([options] { show(*options); });
    add_withdrawing(*command, options);
    auto* accepting =
        add_action(*command, options, "accept", "Accept changed files of a study as a new version",
                   "my-study.yaml --why \"shorter washout\"", false);
    accepting->add_option("--why", options->reason, "reason, for the log")->required();
    accepting->callback([options] { accept(*options); });
}

}  // namespace dihaptic::cli
