#include "study_rehearsal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "base/number.h"
#include "base/plural.h"
#include "base/random.h"
#include "base/shell_word.h"
#include "base/temporary_folder.h"
#include "command.h"
#include "crowd.h"
#include "person/person.h"
#include "session/record.h"
#include "session/rehearsal.h"
#include "session/study_session.h"
#include "session/unfinished_folder.h"
#include "study/allocation.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRehearsed = "rehearsed";  // a person's recording within a session's folder

/// Draws facts about a person: within the limits of `include`, if there are any, otherwise as they
/// are distributed in a group of students.
class FactDraw {
  public:
    FactDraw(const study::StudyFile& study, uint64_t seed, const std::string& id)
        : study_(study), random_(seed, "facts of " + id) {}

    study::Member person(const std::string& id) {
        study::Member out;
        out.id = id;
        out.age = number("age", 20, 30);
        out.sex = word("sex", {"F", "M"});
        out.handedness = word("handedness", {"right"});
        for (const study::FactSpec& fact : study_.facts) {
            out.facts.push_back({fact.name, fact.values.empty() ? number(fact.name, 0, 10)
                                                                : word(fact.name, fact.values)});
        }
        return out;
    }

  private:
    std::string number(const std::string& fact, double low, double high) {
        for (const study::Criterion& c : study_.include) {
            if (c.fact != fact) continue;
            if (c.at_least) low = *c.at_least, high = std::max(high, low + 10);
            if (c.at_most) high = *c.at_most, low = std::min(low, high);
        }
        return number_text(std::floor(random_.uniform(std::ceil(low), high)));
    }
    std::string word(const std::string& fact, std::vector<std::string> values) {
        for (const study::Criterion& c : study_.include) {
            if (c.fact == fact && !c.is.empty()) values = c.is;
        }
        const auto i = static_cast<size_t>(random_.uniform(0, static_cast<double>(values.size())));
        return values[std::min(i, values.size() - 1)];  // uniform() may round up to its upper bound
    }

    const study::StudyFile& study_;
    Random random_;
};

/// Adds people until there are as many as requested. If a fact determines the group, people whose
/// group is already full are skipped.
void add_people(const study::StudyFile& study, const StudyRehearsal& rehearsal,
                study::Roster& roster) {
    constexpr int kMostDraws = 100;  // largest number of draws for each person
    while (static_cast<int>(roster.participants.size()) < rehearsal.people) {
        const std::string id = session::person_id(static_cast<int>(roster.participants.size()) + 1);
        FactDraw facts(study, rehearsal.seed, id);
        for (int draw = 1;; ++draw) {
            study::Member person = facts.person(id);
            try {
                const study::Allocated where = study::allocate(study, roster, person);
                person.group = where.group;
                person.number = where.number;
            } catch (const Error&) {
                if (draw == kMostDraws) throw;
                continue;
            }
            person.added = recording::iso_now();
            person.version = 1;
            roster.participants.push_back(person);
            break;
        }
    }
}

/// Draws the person from the group of the population that has the same name as the study's group,
/// if there is one.
person::Traits traits_of(const person::Population& population, uint64_t seed,
                         const study::Member& member) {
    const auto named = std::ranges::find(population.groups, member.group, &person::Group::name);
    return named == population.groups.end()
               ? person::draw_person(population, seed, member.id)
               : person::draw_person(population, seed, member.id, member.group,
                                     population.laboratory_of(member.id));
}

/// What a participant and, in tasks for two, the partner learned in earlier sessions.
struct Memories {
    person::Learned person;
    person::Learned partner;
};

/// Runs the sessions of a study's simulated people.
class Rehearsing {
  public:
    Rehearsing(const study::StudyFile& study, const StudyRehearsal& rehearsal,
               const study::Roster& roster)
        : study_(study), rehearsal_(rehearsal), roster_(roster) {}

    bool is_done(const std::string& id) const { return all_complete(*roster_.find(id), 0); }

    /// Names the session that a person may not begin because the previous session does not meet the
    /// requirements, with the reason. Empty if the person does all sessions.
    std::string stops(const std::string& id) const {
        const study::Member& member = *roster_.find(id);
        for (size_t i = 1; i < study_.sessions.size(); ++i) {
            const auto unmet = unmet_needs(member, i);
            if (!unmet.empty())
                return fmt::format("{} stops before {}: {}", id, study_.sessions[i].name,
                                   fmt::join(unmet, "; "));
        }
        return "";
    }

    std::string messages(const std::string& id) const {
        const study::Member& member = *roster_.find(id);
        for (size_t i = 0; i < study_.sessions.size(); ++i) {
            const std::string text = session::messages_of(folder(member, i), kRehearsed);
            if (!text.empty()) return fmt::format("{}: {}", study_.sessions[i].name, text);
        }
        return "";
    }

    /// Runs all incomplete sessions of a person, each with what was learned in earlier sessions. To
    /// obtain this, complete sessions before an incomplete one are run again, without keeping their
    /// recordings. Returns the exit status.
    int run(const std::string& id) const {
        const study::Member& member = *roster_.find(id);
        Memories learned;
        try {
            for (size_t i = 0; i < study_.sessions.size() && !all_complete(member, i); ++i) {
                if (!run_session(member, i, learned)) return kFailed;
            }
        } catch (const std::exception& e) {
            fmt::print("{}\n", e.what());
            std::fflush(stdout);
            return kFailed;
        }
        return kOk;
    }

  private:
    std::string folder(const study::Member& member, size_t session) const {
        return session::session_folder(study_, member, session);
    }
    bool is_complete(const study::Member& member, size_t session) const {
        return session::has_session(folder(member, session) + "/" + kRehearsed);
    }
    /// Why a person may not begin this session after completing the previous one; empty if the
    /// session is complete or may be begun.
    std::vector<std::string> unmet_needs(const study::Member& member, size_t session) const {
        if (session == 0 || is_complete(member, session) || !is_complete(member, session - 1))
            return {};
        return study::unmet_needs(study_.sessions[session],
                                  folder(member, session - 1) + "/" + kRehearsed);
    }
    /// Whether a person has completed all sessions from `from` on.
    bool all_complete(const study::Member& member, size_t from) const {
        for (size_t i = from; i < study_.sessions.size(); ++i) {
            if (!is_complete(member, i)) return !unmet_needs(member, i).empty();
        }
        return true;
    }

    bool run_session(const study::Member& member, size_t index, Memories& learned) const {
        if (is_complete(member, index)) {
            const TemporaryFolder scratch;
            return !record(member, index, scratch.path(), false, learned).empty();
        }
        fs::create_directories(folder(member, index));
        const auto place = session::UnfinishedFolder::take(folder(member, index), kRehearsed);
        if (!place) return false;
        dup2(place->messages(), STDOUT_FILENO);
        dup2(place->messages(), STDERR_FILENO);
        const std::string made =
            record(member, index, place->path(), rehearsal_.keep_recordings, learned);
        if (made.empty()) return false;
        place->finish(made);
        place->remove();
        return true;
    }

    /// Records a session. Returns its folder; empty if the session did not end well. `learned`:
    /// what was learned before the session; updated by the session.
    std::string record(const study::Member& member, size_t index, const std::string& out,
                       bool keep_log, Memories& learned) const {
        session::Request request;
        request.file = study_.experiment_of(index, member.group, member.number);
        request.participant = member.id;
        request.order_number = member.number;
        request.simulate = true;
        request.seed = study::seed_of(
            fmt::format("{}/{}/{}", rehearsal_.seed, member.id, study_.sessions[index].name));
        session::Plan plan = session::make_plan(request);
        session::RunOptions run;
        std::shared_ptr<person::Person> person;
        if (plan.task) {
            const auto traits = [&](const study::Member& of) {
                person::Traits drawn = traits_of(rehearsal_.population, rehearsal_.seed, of);
                if (study_.allocation.concealed) drawn.group.clear();  // would reveal the group
                return drawn;
            };
            study::Member other = member;
            other.id = session::partner_of(member.id);
            if (session::is_for_two(plan)) run.partner.id = other.id;
            person = session::sit_down(plan, traits(member), traits(other));
            plan.moved_by.seed = number_text(rehearsal_.seed);
            person->recall(learned.person);
            if (plan.partner) plan.partner->recall(learned.partner);
        }
        run.out = out;
        run.command = command_line();
        run.participant = {member.id, member.age, member.sex, member.handedness};
        run.in_study = session::place_in(study_, member, index);
        run.keep_log = keep_log;
        const session::Recorded session = session::record(plan, run, stop_requested);
        if (!session.good()) {
            fmt::print("{}\n", session.fault.empty()
                                   ? "the session ended before its trials were done"
                                   : session.fault);
            return "";
        }
        if (person) learned.person = person->learned();
        if (plan.partner) learned.partner = plan.partner->learned();
        return session.folder;
    }

    const study::StudyFile& study_;
    const StudyRehearsal& rehearsal_;
    const study::Roster& roster_;
};

/// Claims the folder for this rehearsal. Throws Error when it holds a rehearsal of other files.
void claim(const study::StudyFile& study, const StudyRehearsal& rehearsal) {
    session::StudyVersion now = session::present_version(study);
    now.study.set("rehearsed with seed", Node::of(number_text(rehearsal.seed)));
    now.study.set("population", Node::of(rehearsal.population.title));
    const auto versions = session::versions_of(study);
    if (versions.empty()) {
        session::freeze(study, std::move(now), "rehearsal");
        return;
    }
    const std::string what = session::changed(versions.back(), now);
    if (what.empty()) return;
    throw Error({study.data, 0}, "", "has another rehearsal: " + what,
                "Choose another folder (--out FOLDER), or remove this one.");
}

}  // namespace

void rehearse_study(const StudyRehearsal& given) {
    StudyRehearsal rehearsal = given;
    Diagnostics diagnostics;
    study::StudyFile study =
        session::rehearsed(session::checked_study(rehearsal.file, diagnostics));
    diagnostics.throw_if_errors();
    if (!rehearsal.out.empty()) study.data = rehearsal.out;
    if (rehearsal.people == 0) rehearsal.people = study.people();
    fs::create_directories(study.data);
    const study::StudyLock lock(study);
    claim(study, rehearsal);
    study::Roster roster = study::read_roster(study);
    add_people(study, rehearsal, roster);
    study::write_roster(study, roster);
    const Rehearsing rehearsing(study, rehearsal, roster);
    std::vector<std::string> waiting;
    for (const study::Member& member : roster.participants) {
        if (!rehearsing.is_done(member.id)) waiting.push_back(member.id);
    }
    fmt::print("{}\n{} people in {}, {} to do\n{}", study.title, roster.participants.size(),
               counted(static_cast<int64_t>(study.groups.size()), "group"), waiting.size(),
               study.sessions.size() > 1
                   ? "note: between sessions, simulated people forget what they "
                     "learned fast, and keep what they learned slowly\n"
                   : "");
    CrowdWork work;
    work.jobs = rehearsal.jobs;
    work.out = study.data;
    work.start = [&](const std::string& id) -> std::optional<pid_t> {
        return start_process([&] { return rehearsing.run(id); });
    };
    work.is_done = [&](const std::string& id) { return rehearsing.is_done(id); };
    work.messages = [&](const std::string& id) { return rehearsing.messages(id); };
    for (const std::string& text : run_crowd(work, waiting)) fmt::print(stderr, "{}\n", text);
    for (const study::Member& member : roster.participants) {
        const std::string text = rehearsing.stops(member.id);
        if (!text.empty()) fmt::print("{}\n", text);
    }
    if (exit_code == kOk)
        fmt::print("complete: {}\nnext: dihaptic collect {} --rehearsed {}\n", study.data,
                   shell_file(rehearsal.file), shell_file(study.data));
    else
        fmt::print(
            "some people are still missing from {}: "
            "run the same command again to continue with them\n",
            study.data);
}

}  // namespace dihaptic::cli
