// `dihaptic bench view`: what a picture costs. Definitions in docs/measures.md.
#pragma once

#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

struct ViewFigures {
    std::string renderer;
    int width = 0;
    int height = 0;
    double variance_ms = 0;  ///< median time of a frame
    double plain_ms = 0;     ///< with a plain shadow map, in turn with the others
};

/// The scene of `bench grasp`, the block swinging above the table.
std::vector<ViewFigures> bench_view(int frames, const Progress& progress);

std::string to_json(const std::vector<ViewFigures>& figures);
std::string to_table(const std::vector<ViewFigures>& figures);

}  // namespace dihaptic::measure
