// Writes head.csv: the head's pose in each picture that a headset, or a screen with tracked eyes,
// showed. It is written while the session runs.
#pragma once

#include <array>
#include <fstream>
#include <string>

#include "recording/session.h"

namespace dihaptic::recording {

/// The head's pose in a picture.
struct HeadSeen {
    int64_t tick = 0;           ///< the tick shown
    double time = 0;            ///< predicted session time when its light appears [s]
    std::array<double, 3> p{};  ///< between the eyes, in the world [m]
    std::array<double, 4> R{};  ///< quaternion, w first. The axes are the head's in a headset (x is
                                ///< right, y up, z backward); for a screen, the tracked body's
    bool tracked = false;       ///< measured; otherwise guessed, or the last one seen
};

class HeadsWriter {
  public:
    explicit HeadsWriter(const SessionFolder& folder) : file_(folder.file("head.csv")) {}
    void add(const HeadSeen& head);
    /// Passes added rows to the system, so that they survive the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first row: most sessions have no headset
};

}  // namespace dihaptic::recording
