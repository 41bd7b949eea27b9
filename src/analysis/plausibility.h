// Finds what neither a person nor an experimenter can have intended: a simulated hand that moves
// further than an arm reaches, and a driven body that jumps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace dihaptic::analysis {

class Plausibility {
  public:
    /// `person_simulated`: whether a simulated person moves the hand. `tick` [s].
    Plausibility(bool person_simulated, std::vector<std::string> bodies, double tick);

    /// Takes the next frame of the session.
    void add(const frame::Frame& frame);
    /// A sentence for each implausible movement, with its size and time.
    std::vector<std::string> findings() const;

  private:
    void follow_drives(const frame::Frame& frame);
    void follow_hand(const frame::Frame& frame);

    bool person_simulated_;
    std::vector<std::string> bodies_;
    double tick_;
    std::vector<Vec3> began_;   // where the handles were in the first frame [m]
    std::vector<Vec3> before_;  // where the bodies were in the previous frame [m]
    int64_t sequence_ = -1;     // sequence number of that frame
    struct Largest {
        double way = 0;   // [m]
        double time = 0;  // [s]
    };
    Largest strayed_;  // largest distance of a handle from where it began
    Largest jumped_;   // largest movement of a driven body in a tick
    size_t jumper_ = 0;
};

}  // namespace dihaptic::analysis
