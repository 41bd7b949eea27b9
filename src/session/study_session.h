// A study's sessions on the disk: what was recorded, what comes next, and the versions of the files
// that affect a result.
//
// The study's folder contains the study's file, participants.yaml, log.csv, versions.yaml, and the
// recordings in sessions/PARTICIPANT/SESSION; its folder rehearsal/ contains the same for simulated
// people.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "recording/session.h"
#include "study/schedule.h"

namespace dihaptic::session {

/// The folder with a participant's recordings of a session.
std::string session_folder(const study::StudyFile& study, const study::Member& member,
                           size_t session);
/// What a session's record says about its place in the study.
recording::InStudy place_in(const study::StudyFile& study, const study::Member& member,
                            size_t session);
/// The recordings of a participant, by session, each in the order of its start. Throws Error when a
/// recording cannot be read or is another participant's.
std::vector<study::Visit> visits_of(const study::StudyFile& study, const study::Member& member);
/// Whether a recording counts as its session of the study, which may need only a share of its
/// trials (`resuming`). Its folder lies in sessions/PARTICIPANT/SESSION beside the study's file.
bool counts_in_study(const std::string& recorded, const recording::InStudy& place);
/// Recovers the recordings whose programs were killed, so that it is known how far they got; `tell`
/// is called before each. Returns whether there were any. Throws Error when one cannot be
/// recovered.
bool recover_killed(const std::vector<study::Visit>& visits,
                    const std::function<void(const std::string& folder)>& tell);

/// The folder with all recordings of a participant, which may be deleted; empty if there is none.
/// Throws Error when it is a link or leads through one, or when a session in it is running.
std::string deletable(const study::StudyFile& study, const study::Member& member);
/// Folders of the participant's recordings that belong to no session of the study.
std::vector<std::string> uncounted(const study::StudyFile& study, const study::Member& member);

/// The study with the folder for its rehearsal, where simulated sessions never count as a
/// participant's.
study::StudyFile rehearsed(study::StudyFile study);

/// Reads a study, and plans each session of each group and condition once. Throws Error with every
/// problem found.
study::StudyFile checked_study(const std::string& file, Diagnostics& diagnostics);

/// A state of the files that affect a result. Rigs do not belong to it: they are calibrated anew,
/// and each session records its own.
struct StudyVersion {
    int number = 0;     ///< from 1
    std::string since;  ///< ISO 8601
    std::string why;    ///< reason for the change
    std::string program;
    Node study;        ///< the study's file, without comments
    Node experiments;  ///< the frozen inputs of each experiment, by its name in the study's file

    template <class Visitor>
    void visit(Visitor& v) {
        v("number", number);
        v("since", since);
        v("why", why);
        v("program", program);
        v("study", study);
        v("experiments", experiments);
    }
};

/// The present state of a study's files, with number 0.
StudyVersion present_version(const study::StudyFile& study);
/// The study's versions in their order; none before its first participant.
std::vector<StudyVersion> versions_of(const study::StudyFile& study);
/// Adds a version to versions.yaml. Returns its number.
int freeze(const study::StudyFile& study, StudyVersion version, const std::string& why);
/// The first difference between two versions, in words; empty if they are the same.
std::string changed(const StudyVersion& frozen, const StudyVersion& now);
/// Throws Error when the files are not those of the study's last version, or when that version is
/// lost.
void check_unchanged(const study::StudyFile& study, const StudyVersion& now);

}  // namespace dihaptic::session
