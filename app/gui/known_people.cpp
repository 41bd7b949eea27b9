#include "known_people.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/regular_file.h"
#include "session/study_session.h"
#include "task/file/experiment.h"

namespace dihaptic::gui {
namespace {

namespace fs = std::filesystem;

/// The paths in a folder; empty if it cannot be read.
std::vector<fs::path> paths_in(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code failed;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed))
        out.push_back(i->path());
    return out;
}

bool has_experiment(const study::StudyFile& study, const std::string& experiment) {
    std::error_code failed;
    for (size_t session = 0; session < study.sessions.size(); ++session) {
        for (const auto& [name, path] : study.experiments_of(session)) {
            if (fs::equivalent(path, experiment, failed)) return true;
        }
    }
    return false;
}

/// The study with participants to which an experiment belongs: its file is next to the experiment,
/// or in the folder above, or in `studies` beside the experiment's folder. Returned with its path.
std::optional<std::pair<std::string, study::StudyFile>> study_with(const std::string& experiment) {
    const fs::path here = fs::absolute(experiment).parent_path();
    for (const fs::path& folder : {here, here.parent_path(), here.parent_path() / "studies"}) {
        if (!is_there((folder / "participants.yaml").string())) continue;
        for (const fs::path& file : paths_in(folder)) {
            if (file.extension() != ".yaml") continue;
            try {
                if (task::kind_of(file.string()) != task::FileKind::study) continue;
                study::StudyFile study = study::read_study(file.string());
                if (has_experiment(study, experiment)) return std::pair(file.string(), study);
            } catch (const Error&) {
                continue;  // `dihaptic check` reports faults of files that are not open
            }
        }
    }
    return {};
}

/// The name of the session that comes next for a participant; "" if there is none.
std::string next_session(const study::StudyFile& study, const study::Member& member,
                         const std::vector<study::Visit>& visits) {
    if (!member.takes_part()) return "";
    const study::Next next =
        study::next_for(study, visits, study::seconds_of(recording::iso_now()));
    return next.act == study::Act::none ? "" : study.sessions[next.session].name;
}

}  // namespace

KnownPeople::KnownPeople(std::string out, std::string title, const std::string& experiment)
    : out_(std::move(out)), title_(std::move(title)) {
    add_recorded();
    try {
        add_members(experiment);
    } catch (const Error&) {
        // a damaged study is reported by the commands that run it; who was recorded is known anyway
    }
    std::ranges::sort(people_, [](const KnownPerson& a, const KnownPerson& b) {
        return std::pair(b.last, a.participant.id) < std::pair(a.last, b.participant.id);
    });
}

void KnownPeople::add_recorded() {
    for (const fs::path& path : paths_in(out_)) {
        try {
            const auto info = recording::SessionFolder::open(path.string()).read_info();
            const std::string& id = info.participant.id;
            if (id.empty() || id.starts_with(recording::kSimulatedPrefix)) continue;
            if (info.moved_by.mover == recording::Mover::simulated_person) continue;
            KnownPerson& known = person(id);
            known.complete |=
                info.title == title_ && info.state == recording::SessionState::complete;
            if (info.started < known.last) continue;
            known.last = info.started;
            known.title = info.title;
            known.participant = info.participant;
            if (info.in_study) known.group = info.in_study->group;
        } catch (const Error&) {
            continue;  // not a session, or damaged
        }
    }
}

void KnownPeople::add_members(const std::string& experiment) {
    const auto found = study_with(experiment);
    if (!found) return;
    study_file_ = found->first;
    const study::StudyFile* const study = &found->second;
    study_ = study->title;
    for (const study::Member& member : study::read_roster(*study).participants) {
        KnownPerson& known = person(member.id);
        known.participant = {member.id, member.age, member.sex, member.handedness};
        known.group = member.group;
        known.member = member.takes_part();
        const std::vector<study::Visit> visits = session::visits_of(*study, member);
        known.day = next_session(*study, member, visits);
        for (const study::Visit& visit : visits) {
            const auto info = recording::SessionFolder::open_tables(visit.folder).read_info();
            if (info.started < known.last) continue;
            known.last = info.started;
            known.title = info.title;
        }
    }
}

KnownPerson& KnownPeople::person(const std::string& id) {
    const auto found = std::ranges::find_if(
        people_, [&](const KnownPerson& known) { return known.participant.id == id; });
    if (found != people_.end()) return *found;
    KnownPerson& added = people_.emplace_back();
    added.participant.id = id;
    return added;
}

const KnownPerson* KnownPeople::find(const std::string& id) const {
    const auto found = std::ranges::find_if(
        people_, [&](const KnownPerson& known) { return known.participant.id == id; });
    return found == people_.end() ? nullptr : &*found;
}

std::string KnownPeople::study_of(const std::string& id) const {
    const KnownPerson* const known = find(id);
    return known != nullptr && known->member ? study_file_ : "";
}

std::vector<std::string> KnownPeople::identifiers() const {
    std::vector<std::string> out;
    for (const KnownPerson& known : people_) out.push_back(known.participant.id);
    return out;
}

std::optional<session::Unfinished> KnownPeople::unfinished(const std::string& id) const {
    if (find(id) == nullptr) return {};
    auto found = session::find_unfinished(out_, title_, id);
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

}  // namespace dihaptic::gui
