// Contact problems as sessions meet them, recorded from scenes that random forces shake more and
// more: contacts stick at first, then slide and open too. Newton's method solves the scenes while
// they are recorded.
#pragma once

#include <string>
#include <vector>

#include "contact/problem.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

struct RecordedProblem {
    contact::ContactProblem problem;
    std::vector<contact::Impulse> start;  ///< the impulses of the tick before
};

/// Problems of one kind of scene, with about so many contacts.
struct ProblemGroup {
    std::string family;  ///< block, grasp, stack, wall or pile
    int contacts = 0;
    std::vector<RecordedProblem> problems;
};

/// Problems farther than this from a group's number of contacts are left out.
constexpr double kContactsWithin = 0.2;

/// A block on a table; a block between pads, in the air and under another block; a stack of ten;
/// walls and piles of about 8 to 200 contacts. At most so many problems of each, evenly over time.
std::vector<ProblemGroup> record_problems(size_t most, const Progress& progress);

/// Scenes of the two families that grow, for tests too. Bricks of each course lie across the joints
/// of the one below.
scene::Scene brick_wall_scene(int bricks, int courses);
/// Boxes of many sizes, loosely above a bowl of four slopes: dropped, they lie in a heap that is
/// one.
scene::Scene pile_scene(int boxes);

}  // namespace dihaptic::measure
