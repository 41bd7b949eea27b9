// The quantities of a recorded session that can be drawn over time, each with its meaning.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace dihaptic::gui {

/// All quantities that are numbers, by the names that expressions use; of a vector, its components.
/// Those of the whole frame come first. Names that are known only while a task runs are left out.
std::vector<Choice> drawable_quantities(const scene::Scene& scene);

}  // namespace dihaptic::gui
