// The identity of a rehearsal, stored as rehearsal.yaml in the folder that contains its simulated
// people. Sessions with a different experiment, seed, population or program are never added to that
// rehearsal. The file also contains the request, from which `dihaptic collect` works out which
// people are missing.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "session/plan.h"

namespace dihaptic::session {

inline constexpr int kMostPeople = 9999;
/// First columns of the tables that `dihaptic collect` writes: they identify the person to whom a
/// row belongs.
inline constexpr std::array kCollectedColumns = {"seed", "group", "id"};
/// Additional columns in the tables of a study.
inline constexpr std::array kStudyColumns = {"study_number", "study_session", "study_condition",
                                             "study_version"};

/// What the latest command requested. This is not part of the rehearsal's identity.
struct Asked {
    int people = 0;  ///< number of people, starting with the first; 0: unknown, because an older
                     ///< program made the folder
    int shards = 1;  ///< number of shards among which these people are distributed in turn
    std::string command;  ///< command that simulates them, from any folder; --shard may be added

    template <class Visitor>
    void visit(Visitor& v) {
        v("people", people, Field::number().within(0, kMostPeople));
        v("shards", shards, Field::number().within(1, kMostPeople));
        v("command", command);
    }
    bool operator==(const Asked&) const = default;
};

struct Rehearsal {
    std::string program;
    std::string experiment;  ///< title
    std::string seed;
    Asked asked;
    Node population;
    std::string between;  ///< program that controls the trials; empty if only the file does
    Node inputs;          ///< frozen inputs that affect the result, indexed by file name

    template <class Visitor>
    void visit(Visitor& v) {
        v("program", program);
        v("experiment", experiment);
        v("seed", seed, Field::number().at_least(0));
        v("asked", asked);
        v("population", population);
        v("between", between);
        v("inputs", inputs);
    }
};

/// ID of the n-th person, counted from 1.
std::string person_id(int n);
/// Which of `shards` shards simulates the n-th person; both are counted from 1.
int shard_of(int n, int shards);

/// Returns the identity of a rehearsal. `plan` must not have a simulated person yet. `population`
/// is the population from which the people are drawn.
Rehearsal rehearsal_of(const Plan& plan, Node population);
/// Reads rehearsal.yaml in a folder. Throws Error when the file is missing or cannot be read.
Rehearsal read_rehearsal(const std::string& folder);
/// Describes the first difference between two rehearsals; "" if there is none. `there` is the
/// rehearsal stored in the folder.
std::string difference(const Rehearsal& there, const Rehearsal& here);
/// Describes the first value in which two documents differ; "" if there is none.
std::string difference(const Node& there, const Node& here);

/// Creates the folder, or checks that it contains the same rehearsal, and stores the request. If
/// the folder contains a different rehearsal, throws an Error that names the difference.
void claim(const std::string& folder, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
