// The identity of a rehearsal, in the file rehearsal.yaml of the folder with its people: sessions
// of a different experiment, seed, population or program are never added to it. The file also
// contains the request, from which `dihaptic collect` works out which people are missing.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "session/plan.h"

namespace dihaptic::session {

inline constexpr int kMostPeople = 9999;
/// First columns of the tables that `dihaptic collect` makes: they identify the person of a row.
inline constexpr std::array kCollectedColumns = {"seed", "group", "id"};
/// Further columns of a study's tables.
inline constexpr std::array kStudyColumns = {"study_number", "study_session", "study_condition",
                                             "study_version"};

/// The request of the latest command. It is not part of the rehearsal's identity.
struct Asked {
    int people =
        0;  ///< number of people, from the first on; 0: unknown, in a folder of an older program
    int shards = 1;       ///< number of parts among which these people are distributed in turn
    std::string command;  ///< command for all of them, from any folder; --shard may be added

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
    std::string between;  ///< program that controls the trials; empty: only the file does
    Node inputs;          ///< by file, as frozen by a session: everything that affects the result

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

/// Identifier of the n-th person, counted from 1.
std::string person_id(int n);
/// The n-th person's shard among `shards`, both counted from 1.
int shard_of(int n, int shards);

/// `plan`: has no simulated person yet. `population`: source of the rehearsal's people.
Rehearsal rehearsal_of(const Plan& plan, Node population);
/// Reads rehearsal.yaml in a folder. Throws Error when it is missing or cannot be read.
Rehearsal read_rehearsal(const std::string& folder);
/// The first difference between two rehearsals, in words; "" if there is none. `there`: the
/// folder's rehearsal.
std::string difference(const Rehearsal& there, const Rehearsal& here);
/// The first value in which two documents differ, in words; "" if there is none.
std::string difference(const Node& there, const Node& here);

/// Makes the folder, or checks that it holds the same rehearsal, and notes the request. Throws an
/// Error that names the difference when the folder holds another one.
void claim(const std::string& folder, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
