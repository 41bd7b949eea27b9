// Records contact problems like those of sessions, from scenes shaken by growing random
// forces: contacts stick at first, then also slide and open. Newton's method solves the scenes
// while they are recorded.
#pragma once

#include <string>
#include <vector>

#include "contact/problem.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct RecordedProblem {
    contact::ContactProblem problem;
    std::vector<contact::Impulse> start;  ///< the impulses of the previous tick
};

/// Problems from one kind of scene, with about `contacts` contacts.
struct ProblemGroup {
    std::string family;  ///< block, grasp, stack, wall or pile
    int contacts = 0;
    std::vector<RecordedProblem> problems;
};

/// Problems whose number of contacts differs from the group's by more than this fraction are left
/// out.
constexpr double kContactsWithin = 0.2;

/// A block on a table; a block between pads, in the air and under another block; a stack of ten;
/// walls and piles of about 8 to 200 contacts. At most `most` of each, spread evenly over time.
std::vector<ProblemGroup> record_problems(size_t most, const measure::Progress& progress);

// Scenes of the two growing families, which tests also use.

/// A wall in which bricks of each course lie across the joints of the one below.
scene::Scene brick_wall_scene(int bricks, int courses);
/// Boxes of many sizes, loosely arranged above a bowl with four sloping sides; when dropped, they
/// form a single heap.
scene::Scene pile_scene(int boxes);

}  // namespace dihaptic::bench
