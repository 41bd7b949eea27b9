// The tables and recordings of all participants and sessions of a study.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/text_table.h"
#include "study/roster.h"
#include "study/study_file.h"

namespace dihaptic::cli {

/// The study that a command works on, and the location of its data.
struct StudyData {
    std::string file;       ///< path of the study file
    std::string rehearsed;  ///< folder of a rehearsal; empty for the study's own participants
    bool reveal_groups = false;
};

/// Whether a file is a study file.
bool is_study(const std::string& file);

/// Reads the study. If a rehearsal folder is given, the study's data are taken from there. Throws
/// Error when the study cannot be read or the folder does not exist.
study::StudyFile study_of(const StudyData& data);

/// A participant's complete session.
struct CompleteSession {
    const study::Member& member;
    std::string folder;
    std::vector<std::string> parts;  ///< folders of the session's recordings, several if resumed
};

/// The complete sessions of a study, ordered by participant and session.
class StudySessions {
  public:
    /// `study` must outlive this object. Throws Error when a recording cannot be read.
    explicit StudySessions(const study::StudyFile& study);

    const study::Roster& roster() const { return roster_; }
    const std::vector<CompleteSession>& complete() const { return complete_; }
    /// Describes, in words, the sessions that active participants still have to do, and recordings
    /// of people who are not in the list of participants.
    const std::vector<std::string>& missing() const { return missing_; }

  private:
    study::Roster roster_;
    std::vector<CompleteSession> complete_;
    std::vector<std::string> missing_;
};

/// Returns participants.csv and the joined tables of all complete sessions. Shows progress. Throws
/// Error when a table cannot be read.
std::vector<TextTable> tables_of(const study::StudyFile& study, const StudySessions& sessions,
                                 const StudyData& data);

/// If the groups are concealed, notes in the study's log that `where` has revealed them.
void note_revealed(const study::StudyFile& study, const StudyData& data, const std::string& where);

/// Writes the tables into the folder `out` or, if `out` is empty, into tables/ next to the
/// participants' file.
void collect_study(const StudyData& data, const std::string& out);

}  // namespace dihaptic::cli
