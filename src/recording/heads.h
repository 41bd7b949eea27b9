// Writes head.csv: the head's pose in each picture shown by a headset or by a screen with eye
// tracking. The file is written while the session runs.
#pragma once

#include <array>
#include <fstream>
#include <string>

#include "recording/session.h"

namespace dihaptic::recording {

/// The head's pose when a picture was shown.
struct HeadSeen {
    int64_t tick = 0;           ///< the tick that the picture shows
    double time = 0;            ///< predicted session time at which the picture's light appears [s]
    std::array<double, 3> p{};  ///< midpoint between the eyes, in the world [m]
    std::array<double, 4> R{};  ///< quaternion, w first. The axes are the head's in a headset (x is
                                ///< right, y up, z backward); for a screen, the tracked body's
    bool tracked = false;       ///< whether the pose was measured; if not, it is a guess or the
                                ///< last measured pose
};

class HeadsWriter {
  public:
    explicit HeadsWriter(const SessionFolder& folder) : file_(folder.file("head.csv")) {}
    void add(const HeadSeen& head);
    /// Hands the added rows to the operating system, so that they survive a crash of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first row, because most sessions have no headset
};

}  // namespace dihaptic::recording
