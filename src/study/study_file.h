// The file that describes a study: its groups and how people are allocated to them, who may take
// part, and which experiment is run in each session.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "task/file/task.h"

namespace dihaptic::study {

/// A group of participants.
struct Group {
    std::string name;
    int people = 0;  ///< target number of participants
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the group: letters, digits, - and _."));
        v("people", people,
          Field::number().required().within(1, 9999).says("Target number of participants."));
    }
};

enum class Method { in_turn, blocks, minimisation, fact };
constexpr auto enum_names(Method) {
    return std::array{"in_turn", "blocks", "minimisation", "fact"};
}

/// How the group of the next participant is chosen (allocation.h).
struct Allocation {
    Method method = Method::in_turn;
    int block = 0;                  ///< number of people per block; 0: twice the smallest block
    std::vector<std::string> over;  ///< facts that minimisation balances between groups
    std::string fact;               ///< fact whose value is the name of the group
    double chance = 0.8;  ///< probability that minimisation chooses the best balanced group
    int seed = 1;
    bool concealed = false;  ///< whether groups are hidden from the operator
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("method", method,
          says("How the next participant's group is chosen: in turn, from permuted blocks, by "
               "minimisation, or by a fact of the person, such as a diagnosis."));
        v("block", block,
          Field::number().within(0, 1000).says(
              "Number of people in a permuted block; 0: twice the smallest block that holds the "
              "groups in proportion."));
        v("over", over, says("Facts that minimisation balances between groups."));
        v("fact", fact, says("Fact whose value is the name of the person's group."));
        v("chance", chance,
          Field::number().within(0.5, 1).says(
              "Probability that minimisation chooses the best balanced group."));
        v("seed", seed, Field::number().at_least(0).says("Seed of the allocation."));
        v("concealed", concealed,
          says("Whether groups are concealed from the operator: neither commands nor "
               "participants.yaml name them."));
    }
};

/// A fact that every participant is asked for, in addition to age, sex and handedness.
struct FactSpec {
    std::string name;
    std::vector<std::string> values;  ///< allowed values; empty if the fact is a number
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the fact: letters, digits and _."));
        v("values", values, says("Allowed values; without them, the fact is a number."));
    }
};

/// A condition that a fact about a participant must meet.
struct Criterion {
    std::string fact;
    std::vector<std::string> is;  ///< allowed values; empty if any value is allowed
    std::optional<double> at_least, at_most;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("fact", fact,
          Field::text().required().says("A fact: age, sex, handedness, or one of `facts`."));
        v("is", is, says("Values with which a person may take part."));
        v("at_least", at_least, says("Smallest number with which a person may take part."));
        v("at_most", at_most, says("Largest number with which a person may take part."));
    }
};

/// A condition that the previous session must meet. The proportion of a text, or the mean of a
/// number, is computed over the last attempts at the trials of that session.
struct Condition {
    std::string column;  ///< name of a column of trials.csv
    std::string is;      ///< text whose proportion is computed; if empty, the mean is computed
    std::optional<double> at_least, at_most;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("column", column,
          Field::text().required().says("Column of the earlier session's trials.csv."));
        v("is", is,
          says("Text of which the share of trials is taken, e.g. an outcome; without it, the "
               "column's mean is taken."));
        v("at_least", at_least, says("Smallest share or mean with which the session may begin."));
        v("at_most", at_most, says("Largest share or mean with which the session may begin."));
    }
};

/// A session that every participant has.
struct SessionSpec {
    std::string name;
    std::string experiment;  ///< path of the experiment file, relative to the study file; {group}
                             ///< and {condition} are replaced
    std::optional<double> least_gap,
        most_gap;  ///< minimum and maximum time between the starts of two sessions [h]
    std::vector<Condition> needs;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the session: letters and digits."));
        v("experiment", experiment,
          Field::text().required().says(
              "Experiment file, relative to this file. {group} and {condition} stand for the "
              "participant's group and the session's condition."));
        v("least_gap_h", least_gap,
          Field::number().within(0, 1e5).says("Shortest time from the start of the previous "
                                              "session to the start of this one [h]."));
        v("most_gap_h", most_gap,
          Field::number().within(0, 1e5).says(
              "Longest time from the start of the previous session to the start of this one [h]."));
        v("needs", needs,
          says("Conditions on the previous session, without which this one does not "
               "begin."));
    }
};

/// What happens to a session that was interrupted.
struct Resuming {
    double within = 2;    ///< [h]
    double complete = 1;  ///< fraction of the trials
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("within_h", within,
          Field::number().within(0, 1e5).says(
              "An interrupted session is resumed within this time after its start [h]; later it "
              "starts again."));
        v("complete", complete,
          Field::number().within(0.01, 1).says(
              "Share of trials with which an interrupted session counts as complete once it is too "
              "old to be resumed."));
    }
};

struct StudyFile {
    std::string title;
    std::string about;
    std::vector<Group> groups;
    Allocation allocation;
    std::vector<FactSpec> facts;
    std::vector<Criterion> include;
    std::vector<std::string> conditions;
    task::Order order = task::Order::latin_square;
    std::vector<SessionSpec> sessions;
    Resuming resuming;
    std::string folder;  ///< folder of the study file; not stored in the file
    std::string data;  ///< folder of participants and recordings: the folder of the study file, or
                       ///< a different one
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, Field::text().required().says("Title of the study."));
        v("about", about, says("Description for a reader."));
        v("groups", groups, says("Groups of participants."));
        v("allocation", allocation, says("How participants are allocated to groups."));
        v("facts", facts, says("Facts asked of every participant besides age, sex, handedness."));
        v("include", include, says("Conditions that a person has to meet to take part."));
        v("conditions", conditions,
          says("Conditions, one for each session whose experiment names {condition}, in an order "
               "that differs between participants."));
        v("order", order,
          says("Order of the conditions, by the participant's number in the group, as for blocks "
               "of trials; a shuffled order follows from the allocation's seed."));
        v("sessions", sessions, says("Sessions of every participant, in their order."));
        v("resuming", resuming, says("What happens to a session that was interrupted."));
    }

    int people() const;  ///< target number of participants
    const Group& group(const std::string& name) const;
    /// Returns the number of orders of the conditions that should occur equally often; 1 if the
    /// order does not depend on the participant's number.
    int orders() const;
    /// Returns the conditions in the order in which a participant has them. `number`: number in the
    /// group, from 1.
    std::vector<std::string> conditions_of(const std::string& group, int number) const;
    /// Returns the path of the experiment in session `index`.
    std::string experiment_of(size_t index, const std::string& group, int number) const;
    /// Returns all experiments that a participant may have in session `index`. Maps the name of
    /// each experiment (as in the study file, with placeholders replaced) to its path.
    std::map<std::string, std::string> experiments_of(size_t index) const;
    std::vector<std::string> experiments_of(const SessionSpec& session, const Group& group) const;
    /// Whether people of a group have the experiment of this name, as in experiments_of().
    bool is_done_by(const SessionSpec& session, const std::string& name, const Group& group) const;
    /// Returns the name of the experiment in session `index`, as in experiments_of().
    std::string experiment_name(size_t index, const std::string& group, int number) const;
    /// Returns the name of the session's condition; empty if there are no conditions.
    std::string condition_of(size_t index, const std::string& group, int number) const;
    /// Returns the code that stands for a group while groups are concealed, e.g. "arm 3f2a". The
    /// code depends only on the seed and on the name of the group, not on the other groups.
    std::string code_of(const std::string& name) const;
    /// Returns the name of the group or, while groups are concealed, its code.
    std::string shown_group(const std::string& name) const;
    /// Returns the group that has this name or code; empty if there is none.
    std::string group_shown(const std::string& shown) const;
};

/// Reads study.yaml. Throws Error with all errors in the file. The experiments themselves are
/// checked elsewhere (session/study_session.h).
StudyFile read_study(const std::string& file);

}  // namespace dihaptic::study
