// The command `dihaptic-bench view`: measures the time to draw a picture. docs/measures.md defines
// the figures.
#pragma once

#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::bench {

/// Median times to draw a picture, in turn.
struct PictureTimes {
    int width = 0;
    int height = 0;
    double variance_ms = 0;  ///< with a variance shadow map
    double plain_ms = 0;     ///< with a plain shadow map
    double coarse_ms = 0;    ///< with two thirds of the pixels each way

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("width", f.width, "1", "in pixels");
        v("height", f.height, "1", "in pixels");
        v("variance_ms", f.variance_ms, "ms", "with a variance shadow map");
        v("plain_ms", f.plain_ms, "ms", "with a plain shadow map");
        v("ratio", f.variance_ms / f.plain_ms, "1", "of the two");
        v("coarse_ms", f.coarse_ms, "ms", "with two thirds of the pixels each way");
        v("coarse_hz", 1e3 / f.coarse_ms, "Hz", "pictures per second in that case");
    }
};

struct ViewFigures {
    std::string renderer;
    std::vector<PictureTimes> sizes;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("renderer", f.renderer, "", "");
        v("sizes", f.sizes, "", "median time of a picture");
    }
};

/// Draws a block that swings above a table.
ViewFigures bench_view(int frames, const measure::Progress& progress);

}  // namespace dihaptic::bench
