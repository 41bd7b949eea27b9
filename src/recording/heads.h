// Writes head.csv, which says where the head was in each picture that a headset, or a screen with
// tracked eyes, showed. It is written while the session runs.
#pragma once

#include <array>
#include <fstream>
#include <string>

#include "recording/session.h"

namespace dihaptic::recording {

/// The head in a picture.
struct HeadSeen {
    int64_t tick = 0;           ///< that the picture is of
    double time = 0;            ///< session time when its light came, as foreseen [s]
    std::array<double, 3> p{};  ///< between the eyes, in the world [m]
    std::array<double, 4> R{};  ///< quaternion, w first: in a headset x is right, y up, z backward
                                ///< of the head; before a screen, of the body that is tracked
    bool tracked = false;       ///< it was measured; otherwise guessed, or where it was seen last
};

class HeadsWriter {
  public:
    explicit HeadsWriter(const SessionFolder& folder) : file_(folder.file("head.csv")) {}
    void add(const HeadSeen& head);
    /// Passes what was added to the system, so that it survives the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first: most sessions have no headset
};

}  // namespace dihaptic::recording
