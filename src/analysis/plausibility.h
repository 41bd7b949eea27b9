// Finds movements that neither a person nor an experimenter can have intended: a simulated hand
// that moves farther than an arm can reach, and a driven body that jumps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace dihaptic::analysis {

class Plausibility {
  public:
    /// `person_simulated`: whether the hand is moved by a simulated person. `tick`: tick period
    /// [s].
    Plausibility(bool person_simulated, std::vector<std::string> bodies, double tick);

    /// Adds the next frame of the session.
    void add(const frame::Frame& frame);
    /// Returns a sentence for each implausible movement, with its size and time.
    std::vector<std::string> findings() const;

  private:
    void follow_drives(const frame::Frame& frame);
    void follow_hand(const frame::Frame& frame);

    bool person_simulated_;
    std::vector<std::string> bodies_;
    double tick_;
    std::vector<Vec3> began_;   // positions of the handles in the first frame [m]
    std::vector<Vec3> before_;  // positions of the bodies in the previous frame [m]
    int64_t sequence_ = -1;     // sequence number of the previous frame
    struct Largest {
        double way = 0;   // [m]
        double time = 0;  // [s]
    };
    Largest strayed_;  // largest distance of a handle from its first position
    Largest jumped_;   // largest movement of a driven body within one tick
    size_t jumper_ = 0;
};

}  // namespace dihaptic::analysis
