#include "study/roster.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>
#include <thread>

#include "base/choices.h"
#include "base/field_writer.h"
#include "base/number.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/table.h"
#include "base/text_file.h"
#include "recording/session.h"
#include "study/facts.h"
#include "study/identifier.h"

namespace dihaptic::study {
namespace {

std::string file_of(const StudyFile& study) {
    return study.data + "/participants.yaml";
}

/// Throws Error when a fact about the person is missing, or has a value that the fact cannot have.
void check_fact(const StudyFile& study, const Member& person, const std::string& name) {
    const std::string value = person.fact(name);
    const bool standard = spec_of(study, name) == nullptr;
    const std::string option =
        standard ? fmt::format("--{} VALUE", name) : fmt::format("--fact {}=VALUE", name);
    if (value.empty()) {
        throw Error({"participant", 0}, person.id,
                    fmt::format("lacks '{}', which the study asks for", name),
                    fmt::format("Add {}.", option));
    }
    if (is_number(study, name)) {
        if (!finite_number(value))
            throw Error(
                {"participant", 0}, person.id,
                fmt::format("has '{}' for '{}', which must be a number", shortened(value), name),
                fmt::format("Write {} with a number.", option));
    } else if (!standard) {
        const auto& values = spec_of(study, name)->values;
        if (std::ranges::find(values, value) == values.end())
            throw Error({"participant", 0}, person.id,
                        fmt::format("has '{}' for '{}'", shortened(value), name),
                        fmt::format("Known: {}.", listed(values)));
    }
}

std::string in_small(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// Throws Error when an identifier is invalid, or when an identifier or a place occurs twice.
void check_places(const Roster& roster, const std::string& file) {
    std::set<std::string> ids;
    std::set<std::pair<std::string, int>> places;
    const auto fault = [&](const std::string& id, const std::string& what) {
        return Error({file, 0}, id, what, "Restore the file: log.csv says who was added.");
    };
    for (const Member& member : roster.participants) {
        const IdentifierFault wrong = fault_of_identifier(member.id);
        if (wrong != IdentifierFault::none && wrong != IdentifierFault::simulated)
            throw fault(member.id, "is not an identifier");
        if (!ids.insert(in_small(member.id)).second) throw fault(member.id, "is listed twice");
        if (member.takes_part() && !places.emplace(member.group, member.number).second)
            throw fault(member.id,
                        fmt::format("has number {} in its group, as does another participant",
                                    member.number));
    }
}

/// Returns the facts that the study uses: those that it defines, and those on which inclusion or
/// the allocation to a group depends.
std::vector<std::string> needed_facts(const StudyFile& study) {
    std::vector<std::string> out;
    const auto add = [&](const std::string& name) {
        if (std::ranges::find(out, name) == out.end()) out.push_back(name);
    };
    for (const FactSpec& fact : study.facts) add(fact.name);
    for (const Criterion& criterion : study.include) add(criterion.fact);
    for (const std::string& fact : study.allocation.over) add(fact);
    if (!study.allocation.fact.empty()) add(study.allocation.fact);
    return out;
}

}  // namespace

void check_identifier(const std::string& id) {
    check_identifier(id, "participant");
}

std::string Member::fact(const std::string& name) const {
    if (name == "age") return age;
    if (name == "sex") return sex;
    if (name == "handedness") return handedness;
    const auto found = std::ranges::find(facts, name, &recording::Fact::name);
    return found == facts.end() ? "" : found->value;
}

const Member* Roster::find(const std::string& id) const {
    const auto found = std::ranges::find(participants, id, &Member::id);
    return found == participants.end() ? nullptr : &*found;
}

int Roster::active(const std::string& group) const {
    return static_cast<int>(std::ranges::count_if(
        participants, [&](const Member& m) { return m.takes_part() && m.group == group; }));
}

Roster read_roster(const StudyFile& study) {
    Roster out;
    const std::string file = file_of(study);
    if (!is_there(file)) return out;
    Diagnostics diagnostics;
    read_fields(out, read_yaml(file), diagnostics);
    diagnostics.throw_if_errors();
    if (!out.study.empty() && out.study != study.title) {
        throw Error({file, 0}, "study", fmt::format("is '{}', not '{}'", out.study, study.title),
                    "Give each study a folder of its own.");
    }
    for (Member& member : out.participants) {
        const std::string group = study.group_shown(member.group);
        if (group.empty()) {
            throw Error(
                {file, 0}, member.id,
                fmt::format("is in the group '{}', which the study does not have", member.group),
                "Restore the study's groups, or its allocation's seed.");
        }
        member.group = group;
    }
    check_places(out, file);
    return out;
}

void write_roster(const StudyFile& study, Roster roster) {
    roster.study = study.title;
    for (Member& member : roster.participants) member.group = study.shown_group(member.group);
    write_file("# Written by dihaptic participant: see its --help before you change this file.\n" +
                   to_yaml(write_fields(roster)),
               file_of(study), Keep::at_once);
}

std::vector<std::string> reasons_against(const StudyFile& study, const Member& person) {
    check_identifier(person.id);
    std::set<std::string> names;
    for (const recording::Fact& fact : person.facts) {
        if (!names.insert(fact.name).second)
            throw Error({"participant", 0}, fact.name, "is given twice", "Give each fact once.");
        if (spec_of(study, fact.name) == nullptr)
            throw Error({"participant", 0}, fact.name, "is not a fact that the study asks for",
                        "List it under 'facts' in the study's file, or leave it out.");
    }
    std::vector<std::string> needed = needed_facts(study);
    if (!person.age.empty()) needed.emplace_back("age");
    for (const std::string& fact : needed) check_fact(study, person, fact);
    std::vector<std::string> out;
    for (const Criterion& c : study.include) {
        const std::string value = person.fact(c.fact);
        const std::optional<double> number = finite_number(value);
        if (!c.is.empty() && std::ranges::find(c.is, value) == c.is.end())
            out.push_back(fmt::format("{} is {}, not {}", c.fact, value, listed(c.is)));
        if (c.at_least && number && *number < *c.at_least)
            out.push_back(
                fmt::format("{} is {}; at least {} is required", c.fact, value, *c.at_least));
        if (c.at_most && number && *number > *c.at_most)
            out.push_back(
                fmt::format("{} is {}; at most {} is allowed", c.fact, value, *c.at_most));
    }
    return out;
}

void log(const StudyFile& study, const std::string& action, const std::string& participant,
         const std::string& detail) {
    const std::string file = study.data + "/log.csv";
    check_replaceable(file);
    const Descriptor out(
        ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666));
    std::string text;
    char last = '\n';
    const off_t size = out ? ::lseek(out.get(), 0, SEEK_END) : 0;
    if (size == 0) text = "time,action,participant,detail\n";
    if (size > 0 && ::pread(out.get(), &last, 1, size - 1) == 1 && last != '\n') text = "\n";
    for (const std::string& cell : {recording::iso_now(), action, participant})
        text += to_csv(Table::Cell(cell)) + ",";
    text += to_csv(Table::Cell(detail)) + "\n";
    // uses a single write, so that lines written by different programs are not interleaved
    if (!out || ::write(out.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        ::fsync(out.get()) != 0) {
        throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                    "Nothing was changed: repeat the command once the file can be written.");
    }
}

StudyLock::StudyLock(const StudyFile& study)
    : descriptor_(::open(study.data.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY)) {
    constexpr int kPatience = 100;  // in tenths of a second
    for (int i = 0; i < kPatience; ++i) {
        // on a file system without locks, the program continues without a lock
        if (!descriptor_ || ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0 ||
            errno != EWOULDBLOCK)
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    throw Error({study.data, 0}, "", "has been in use by another dihaptic for 10 s",
                "Repeat the command once that program has ended.");
}

}  // namespace dihaptic::study
