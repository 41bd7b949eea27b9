#include "study/roster.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

#include "base/choices.h"
#include "base/field_writer.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/table.h"
#include "base/text_file.h"
#include "recording/session.h"
#include "study/facts.h"

namespace dihaptic::study {
namespace {

std::string file_of(const StudyFile& study) {
    return study.data + "/participants.yaml";
}

void check_identifier(const std::string& id) {
    const auto fault = [&](const char* what, const char* remedy) {
        return Error({"participant", 0}, shortened(id), what, remedy);
    };
    const bool word =
        std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    if (id.empty() || !word || id.size() > 32)
        throw fault("is not an identifier", "Use letters and digits, 32 at most, e.g. S07.");
    if (std::none_of(id.begin(), id.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
        throw fault("has no digit, and may be a person's name",
                    "Use an identifier, e.g. S07, and keep the list of names elsewhere.");
}

/// Throws Error when a person's fact is missing, or is not a value of that fact.
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
            throw Error({"participant", 0}, person.id,
                        fmt::format("has '{}' for '{}', which is a number", shortened(value), name),
                        fmt::format("Write {} with a number.", option));
    } else if (!standard) {
        const auto& values = spec_of(study, name)->values;
        if (std::ranges::find(values, value) == values.end())
            throw Error({"participant", 0}, person.id,
                        fmt::format("has '{}' for '{}'", shortened(value), name),
                        fmt::format("Known: {}.", listed(values)));
    }
}

/// The facts that the study uses: its own ones, and those on which a person's part depends.
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

std::string Member::fact(const std::string& name) const {
    if (name == "age") return age;
    if (name == "sex") return sex;
    if (name == "handedness") return handedness;
    const auto found = std::ranges::find(facts, name, &Fact::name);
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
    return out;
}

void write_roster(const StudyFile& study, Roster roster) {
    for (Member& member : roster.participants) member.group = study.shown_group(member.group);
    write_file("# Written by dihaptic participant: see --help there before you change it.\n" +
                   to_yaml(write_fields(roster)),
               file_of(study), Keep::at_once);
}

std::vector<std::string> reasons_against(const StudyFile& study, const Member& person) {
    check_identifier(person.id);
    for (const Fact& fact : person.facts) {
        if (spec_of(study, fact.name) == nullptr)
            throw Error({"participant", 0}, fact.name, "is not a fact that the study asks for",
                        "List it under 'facts' in the study's file, or leave it out.");
    }
    for (const std::string& fact : needed_facts(study)) check_fact(study, person, fact);
    std::vector<std::string> out;
    for (const Criterion& c : study.include) {
        const std::string value = person.fact(c.fact);
        const std::optional<double> number = finite_number(value);
        if (!c.is.empty() && std::ranges::find(c.is, value) == c.is.end())
            out.push_back(fmt::format("{} is {}, not {}", c.fact, value, listed(c.is)));
        if (c.at_least && number && *number < *c.at_least)
            out.push_back(
                fmt::format("{} is {}, at least {} is asked for", c.fact, value, *c.at_least));
        if (c.at_most && number && *number > *c.at_most)
            out.push_back(
                fmt::format("{} is {}, at most {} is asked for", c.fact, value, *c.at_most));
    }
    return out;
}

void log(const StudyFile& study, const std::string& action, const std::string& participant,
         const std::string& detail) {
    const std::string file = study.data + "/log.csv";
    std::string text = is_there(file) ? read_text_file(file) : "time,action,participant,detail\n";
    for (const std::string& cell : {recording::iso_now(), action, participant})
        text += to_csv(Table::Cell(cell)) + ",";
    write_file(text + to_csv(Table::Cell(detail)) + "\n", file, Keep::at_once);
}

StudyLock::StudyLock(const StudyFile& study)
    : descriptor_(::open(study.data.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY)) {
    // a file system without locks offers nothing to wait for
    if (!descriptor_ || ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return;
    throw Error({study.data, 0}, "", "is in use: another dihaptic changes its participants",
                "Repeat the command once that one has ended.");
}

}  // namespace dihaptic::study
