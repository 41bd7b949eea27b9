// The tables and recordings of all participants and sessions of a study.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/text_table.h"
#include "study/roster.h"
#include "study/study_file.h"

namespace dihaptic::cli {

/// The study that a command is about, and where its data are.
struct StudyData {
    std::string file;       ///< the study's file
    std::string rehearsed;  ///< folder of a rehearsal; empty: the study's own participants
    bool reveal_groups = false;
};

/// Whether a file is a study.
bool is_study(const std::string& file);

/// The study. If a rehearsal's folder is named, the study's data are read from there. Throws Error
/// when the study cannot be read or the folder does not exist.
study::StudyFile study_of(const StudyData& data);

/// A complete session of a participant.
struct CompleteSession {
    const study::Member& member;
    std::string folder;
    std::vector<std::string> parts;  ///< folders of all its recordings, if it was resumed, in order
};

/// The complete sessions of a study, in the order of its participants and sessions.
class StudySessions {
  public:
    /// `study` must outlive it. Throws Error when a recording cannot be read.
    explicit StudySessions(const study::StudyFile& study);

    const study::Roster& roster() const { return roster_; }
    const std::vector<CompleteSession>& complete() const { return complete_; }
    /// Sessions that participants who take part still have to do, and recordings of people who are
    /// not in the list of participants, in words.
    const std::vector<std::string>& missing() const { return missing_; }

  private:
    study::Roster roster_;
    std::vector<CompleteSession> complete_;
    std::vector<std::string> missing_;
};

/// participants.csv, and the tables of all complete sessions, joined. Shows progress. Throws Error
/// when one cannot be read.
std::vector<TextTable> tables_of(const study::StudyFile& study, const StudySessions& sessions,
                                 const StudyData& data);

/// Notes in the study's log that the groups have been named in `where`, if they are concealed.
void note_revealed(const study::StudyFile& study, const StudyData& data, const std::string& where);

/// Writes the tables into a folder; empty: tables/ next to the participants' file.
void collect_study(const StudyData& data, const std::string& out);

}  // namespace dihaptic::cli
