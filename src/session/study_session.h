// Manages the sessions of a study on the disk: what has been recorded, what comes next, and the
// versions of the files that affect the results.
//
// The study's folder contains the study's file, participants.yaml, log.csv, versions.yaml, and the
// recordings in sessions/PARTICIPANT/SESSION; the subfolder rehearsal/ contains the same files for
// simulated people.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "recording/session.h"
#include "study/schedule.h"

namespace dihaptic::session {

/// Returns the folder that contains a participant's recordings of a session.
std::string session_folder(const study::StudyFile& study, const study::Member& member,
                           size_t session);
/// Returns what a session's record says about the session's place in the study.
recording::InStudy place_in(const study::StudyFile& study, const study::Member& member,
                            size_t session);
/// Returns the recordings of a participant, grouped by session and ordered by start time. Throws
/// Error if a recording cannot be read or belongs to another participant.
std::vector<study::Visit> visits_of(const study::StudyFile& study, const study::Member& member);
/// Whether a recording counts as the session of the study that it belongs to; a share of the trials
/// may be enough for this (see `resuming`). The recording must be in sessions/PARTICIPANT/SESSION
/// next to the study's file.
bool counts_in_study(const std::string& recorded, const recording::InStudy& place);
/// Recovers recordings whose programs were killed, so that it is known how far they got; calls
/// `tell` before each recovery. Returns whether there were any. Throws Error if a recording cannot
/// be recovered.
bool recover_killed(const std::vector<study::Visit>& visits,
                    const std::function<void(const std::string& folder)>& tell);

/// Returns the folder with all recordings of a participant, if it may be deleted; empty if there is
/// no such folder. Throws Error if the folder is a link or is reached through a link, or if one of
/// its sessions is running.
std::string deletable(const study::StudyFile& study, const study::Member& member);
/// Returns the folders of a participant's recordings that do not belong to any session of the
/// study.
std::vector<std::string> uncounted(const study::StudyFile& study, const study::Member& member);

/// Returns the study with the folder of its rehearsal instead of its own, so that simulated
/// sessions never count as a participant's.
study::StudyFile rehearsed(study::StudyFile study);

/// Reads a study and plans each session of each group and condition once. Throws an Error that
/// contains every problem found.
study::StudyFile checked_study(const std::string& file, Diagnostics& diagnostics);

/// A version of the files that affect the results. Rigs are not included, because they are
/// recalibrated from time to time, and each session records its own rig.
struct StudyVersion {
    int number = 0;     ///< from 1
    std::string since;  ///< ISO 8601
    std::string why;    ///< reason for the change
    std::string program;
    Node study;        ///< the contents of the study's file, without comments
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

/// Returns the current version of a study's files, with number 0.
StudyVersion present_version(const study::StudyFile& study);
/// Returns the study's versions in order; empty before its first participant.
std::vector<StudyVersion> versions_of(const study::StudyFile& study);
/// Adds a version to versions.yaml. Returns the number of the version.
int freeze(const study::StudyFile& study, StudyVersion version, const std::string& why);
/// Describes the first difference between two versions; empty if they are the same.
std::string changed(const StudyVersion& frozen, const StudyVersion& now);
/// Throws Error if the files differ from those of the study's last version, or if that version is
/// lost.
void check_unchanged(const study::StudyFile& study, const StudyVersion& now);

}  // namespace dihaptic::session
