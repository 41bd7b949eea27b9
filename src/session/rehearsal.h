// The identity of a rehearsal, in the file rehearsal.yaml of the folder with its people: sessions
// of another experiment, seed, population or program are never put into it. The file also has what
// was asked for, by which `dihaptic collect` knows who is missing.
#pragma once

#include <string>

#include "base/field.h"
#include "session/plan.h"

namespace dihaptic::session {

inline constexpr int kMostPeople = 9999;

/// What the latest command asked for. It is no part of the rehearsal's identity.
struct Asked {
    int people = 0;       ///< the first so many; 0: not known, in a folder of an older program
    int shards = 1;       ///< parts that these people are done in, person by person in turn
    std::string command;  ///< what does them all, from any folder; --shard may be added

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
    std::string between;  ///< name of what decides between trials; empty: the file alone
    Node inputs;  ///< by file, as a session freezes them: everything that affects the result

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

/// Identifier of the n-th person, from 1.
std::string person_id(int n);
/// Shard of `shards` that the n-th person is in, both from 1.
int shard_of(int n, int shards);

/// `plan`: without a simulated person yet. `population`: who its people are.
Rehearsal rehearsal_of(const Plan& plan, Node population);
/// Reads rehearsal.yaml in a folder. Throws Error when it is missing or cannot be read.
Rehearsal read_rehearsal(const std::string& folder);
/// The first difference of what they are, in words; "" if there is none. `there`: the folder's
/// rehearsal.
std::string difference(const Rehearsal& there, const Rehearsal& here);

/// Makes the folder, or checks that it holds the same rehearsal, and notes what is asked for.
/// Throws an Error that names the difference when it holds another one.
void claim(const std::string& folder, const Rehearsal& rehearsal);

}  // namespace dihaptic::session
