// What a folder of rehearsed people is a rehearsal of: rehearsal.yaml, beside them. Sessions of
// another experiment, seed, population or program are never put among them.
#pragma once

#include <string>

#include "experiment/plan.h"
#include "person/population.h"

namespace dihaptic::cli {

struct Rehearsal {
    std::string program;
    std::string experiment;  ///< title
    std::string seed;
    Node population;
    Node inputs;  ///< as a session freezes them, by file: everything that makes a difference

    template <class Visitor>
    void visit(Visitor& v) {
        v("program", program);
        v("experiment", experiment);
        v("seed", seed);
        v("population", population);
        v("inputs", inputs);
    }
};

/// Of a plan whose person is not seated yet.
Rehearsal rehearsal_of(const experiment::Plan& plan, const person::Population& population);
/// Throws Error when the folder does not say, or cannot be read.
Rehearsal read_rehearsal(const std::string& folder);
/// In words, the first difference; "" when there is none. `there`: in the folder.
std::string difference(const Rehearsal& there, const Rehearsal& here);

/// Makes the folder, or sees that what it holds is of the same rehearsal. Throws Error, naming the
/// difference, when it is of another one.
void claim(const std::string& folder, const Rehearsal& rehearsal);

}  // namespace dihaptic::cli
