// The identity of a rehearsal, in the file rehearsal.yaml of the folder with its people: sessions
// of another experiment, seed, population or program are never put into it.
#pragma once

#include <string>

#include "person/population.h"
#include "session/plan.h"

namespace dihaptic::cli {

/// With this the name of a folder begins in which a person's session is made.
inline constexpr const char* kUnfinished = "unfinished-";

struct Rehearsal {
    std::string program;
    std::string experiment;  ///< title
    std::string seed;
    Node population;
    Node inputs;  ///< by file, as a session freezes them: everything that affects the result

    template <class Visitor>
    void visit(Visitor& v) {
        v("program", program);
        v("experiment", experiment);
        v("seed", seed);
        v("population", population);
        v("inputs", inputs);
    }
};

/// The population of a file; "": the program's own.
person::Population population_of(const std::string& file, bool real_objects);

/// `plan`: without a simulated person yet.
Rehearsal rehearsal_of(const session::Plan& plan, const person::Population& population);
/// Reads rehearsal.yaml in a folder. Throws Error when it is missing or cannot be read.
Rehearsal read_rehearsal(const std::string& folder);
/// The first difference, in words; "" if there is none. `there`: the folder's rehearsal.
std::string difference(const Rehearsal& there, const Rehearsal& here);

/// Makes the folder, or checks that it holds the same rehearsal. Throws an Error that names the
/// difference when it holds another one.
void claim(const std::string& folder, const Rehearsal& rehearsal);

}  // namespace dihaptic::cli
