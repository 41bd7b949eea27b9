// The participants of a study, stored in participants.yaml next to the study's file, and the log of
// every action that concerns them. Both contain only identifiers: a list of names must be kept
// elsewhere.
#pragma once

#include <string>
#include <vector>

#include "base/descriptor.h"
#include "recording/session.h"
#include "study/study_file.h"

namespace dihaptic::study {

/// A participant.
struct Member {
    std::string id;
    std::string group;
    int number = 0;  ///< number in the group, from 1; free again after a withdrawal
    std::string age, sex, handedness;
    std::vector<recording::Fact> facts;
    std::string added;      ///< ISO 8601
    int version = 0;        ///< version of the study's files at the time when the person was added
    std::string withdrawn;  ///< time of withdrawal (ISO 8601); empty if the person takes part
    std::string reason;     ///< reason for the withdrawal
    bool data_deleted = false;

    template <class Visitor>
    void visit(Visitor& v) {
        v("id", id, Field::text().required());
        v("group", group, Field::text().required());
        v("number", number, Field::number().required().within(1, 9999));
        v("age", age);
        v("sex", sex);
        v("handedness", handedness);
        v("facts", facts);
        v("added", added);
        v("version", version);
        v("withdrawn", withdrawn);
        v("reason", reason);
        v("data_deleted", data_deleted);
    }

    bool takes_part() const { return withdrawn.empty(); }
    /// Returns the value of age, sex, handedness or a fact that the study defines; empty if it is
    /// not known.
    std::string fact(const std::string& name) const;
};

struct Roster {
    std::string study;                 ///< title of the study to which the participants belong
    std::vector<Member> participants;  ///< in the order in which they were added

    template <class Visitor>
    void visit(Visitor& v) {
        v("study", study);
        v("participants", participants);
    }

    const Member* find(const std::string& id) const;
    /// Number of people in a group who take part, i.e. have not withdrawn.
    int active(const std::string& group) const;
};

/// Reads the participants of the study; returns none if there is no file. Throws Error when the
/// file is damaged, belongs to another study, names a group that the study does not have, or
/// contains a participant or a place twice.
Roster read_roster(const StudyFile& study);
void write_roster(const StudyFile& study, Roster roster);

/// Checks the identifier and the facts of a person. Returns the reasons why the person cannot take
/// part; empty if there are none. Throws Error for an invalid identifier, for an invalid value, and
/// for a missing fact.
std::vector<std::string> reasons_against(const StudyFile& study, const Member& person);

/// Throws Error unless the text is a valid identifier: it must consist of letters and digits and
/// contain a digit, so that it is not a name.
void check_identifier(const std::string& id);

/// Adds a line with the current time to log.csv in the study's folder. Must be called before the
/// action itself, so that nothing happens that is not in the log. Throws Error when the line cannot
/// be written.
void log(const StudyFile& study, const std::string& action, const std::string& participant,
         const std::string& detail);

/// Prevents other programs from changing the study's participants. Waits for a program that is
/// changing them, and throws Error after ten seconds.
class StudyLock {
  public:
    explicit StudyLock(const StudyFile& study);

  private:
    Descriptor descriptor_;
};

}  // namespace dihaptic::study
