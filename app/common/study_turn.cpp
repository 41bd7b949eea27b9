#include "common/study_turn.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/number.h"
#include "base/regular_file.h"

namespace dihaptic::app {
namespace {

const study::Member& member_of(const study::StudyFile& study, const study::Roster& roster,
                               const std::string& file, const std::string& id) {
    if (id.empty()) {
        throw Error({"--participant", 0}, "",
                    "is missing: a study runs a participant's next session",
                    "Add e.g. --participant S07.");
    }
    const study::Member* member = roster.find(id);
    if (member == nullptr) {
        throw Error({"--participant", 0}, id, fmt::format("has not been added to {}", study.title),
                    fmt::format("First: dihaptic participant add {} {}.", file, id));
    }
    if (!member->takes_part()) {
        throw Error({"--participant", 0}, id, fmt::format("withdrew on {}", member->withdrawn),
                    "Add another participant in place of this one.");
    }
    return *member;
}

/// The participant's next step in the study, whether allowed or not.
study::Next next_of(const study::StudyFile& study, const study::Member& member, bool simulated,
                    const std::function<void(const std::string&)>& tell) {
    const study::StudyFile where = simulated ? session::rehearsed(study) : study;
    auto visits = session::visits_of(where, member);
    const auto tell_killed = [&](const std::string& folder) {
        tell(fmt::format("{} was killed: it is recovered", folder));
    };
    if (session::recover_killed(visits, tell_killed)) visits = session::visits_of(where, member);
    study::Next next = study::next_for(study, visits, study::seconds_of(recording::iso_now()));
    // simulated sessions follow one another without a pause
    if (simulated && next.act == study::Act::begin) next.against.clear();
    if (next.act == study::Act::begin && !next.after.empty()) {
        const auto unmet = study::unmet_needs(study.sessions[next.session], next.after);
        next.against.insert(next.against.end(), unmet.begin(), unmet.end());
    }
    return next;
}

void check_allowed(const study::StudyFile& study, const study::Member& member,
                   const study::Next& next, const std::string& despite, bool simulated,
                   const std::function<void(const std::string&)>& tell) {
    if (next.act == study::Act::none) {
        throw Error({"--participant", 0}, member.id,
                    fmt::format("has completed all {} sessions", study.sessions.size()),
                    "dihaptic participant show lists them.");
    }
    const std::string& name = study.sessions[next.session].name;
    if (next.against.empty()) return;
    const std::string why = fmt::format("{}", fmt::join(next.against, "; "));
    if (!despite.empty()) {
        study::log(study, simulated ? "simulate despite" : "despite", member.id,
                   fmt::format("{}: {}; {}", name, why, despite));
        tell(fmt::format("WARNING: {} begins despite the study's rules: {}", name, why));
        return;
    }
    throw Error({"--participant", 0}, member.id, fmt::format("may not begin {}: {}", name, why),
                "To begin nevertheless, which is logged: --despite REASON.");
}

}  // namespace

void StudyTurn::log_begin() const {
    const char* action = simulated ? "simulate" : resume.empty() ? "begin" : "resume";
    study::log(study, action, participant.id, in_study.session);
}

StudyTurn study_turn(const std::string& file, const std::string& participant,
                     const std::string& despite, bool simulated,
                     const std::function<void(const std::string&)>& tell) {
    const study::StudyFile study = study::read_study(file);
    const study::StudyLock lock(study);
    const study::Roster roster = study::read_roster(study);
    const study::Member& member = member_of(study, roster, file, participant);
    const study::Next next = next_of(study, member, simulated, tell);
    check_allowed(study, member, next, despite, simulated, tell);
    StudyTurn out;
    out.experiment = study.experiment_of(next.session, member.group, member.number);
    session::check_unchanged(study, session::present_version(study));
    out.out = session::session_folder(simulated ? session::rehearsed(study) : study, member,
                                      next.session);
    out.resume = next.folder;
    out.participant = {member.id, member.age, member.sex, member.handedness};
    out.in_study = session::place_in(study, member, next.session);
    const std::string& name = out.in_study.session;
    out.person_seed = study::seed_of(fmt::format("{}/{}", study.allocation.seed, member.id));
    out.seed = study::seed_of(fmt::format("{}/{}/{}", study.allocation.seed, member.id, name));
    if (!next.note.empty()) tell("note: " + next.note);
    tell(fmt::format("{}: {} of {}, session {} of {}{}", study.title, member.id,
                     study.allocation.concealed ? "a concealed group" : "group " + member.group,
                     next.session + 1, study.sessions.size(),
                     out.resume.empty() ? ": " + name : fmt::format(": {} is resumed", name)));
    out.study = study;
    out.simulated = simulated;
    return out;
}

}  // namespace dihaptic::app
