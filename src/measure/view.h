// The command `dihaptic bench view`: measures the time to draw a picture. docs/measures.md defines
// the figures.
#pragma once

#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

struct ViewFigures {
    std::string renderer;
    int width = 0;
    int height = 0;
    double variance_ms = 0;  ///< median time of a picture, with a variance shadow map
    double plain_ms = 0;     ///< median time with a plain shadow map; the two take turns
};

/// Draws a block that swings above a table.
std::vector<ViewFigures> bench_view(int frames, const Progress& progress);

std::string to_json(const std::vector<ViewFigures>& figures);
std::string to_table(const std::vector<ViewFigures>& figures);

}  // namespace dihaptic::measure
