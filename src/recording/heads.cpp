#include "recording/heads.h"

#include <fmt/format.h>

namespace dihaptic::recording {

void HeadsWriter::add(const HeadSeen& head) {
    if (!out_.is_open()) {
        out_.open(file_);
        out_ << "tick,shown_s,x_m,y_m,z_m,qw,qx,qy,qz,tracked\n";
    }
    out_ << fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f},{:.7f},{:.7f},{:.7f},{:.7f},{}\n",
                        head.tick, head.time, head.p[0], head.p[1], head.p[2], head.R[0], head.R[1],
                        head.R[2], head.R[3], head.tracked ? 1 : 0);
}

}  // namespace dihaptic::recording
