// Several procedures in one series of trials, in an order that nobody can foresee: each trial
// belongs to one of those that are not done, drawn by chance. The seed and the answers so far
// decide everything, so giving the same answers again makes the same state.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "experiment/procedures/procedure.h"

namespace dihaptic::experiment {

class Interleaved {
  public:
    /// Throws Error without tracks.
    Interleaved(std::vector<Procedure> tracks, uint64_t seed);

    /// Which of the tracks the next trial belongs to.
    size_t track() const { return track_; }
    double level() const { return tracks_[track_].level(); }
    /// Of that track's trial; otherwise as Procedure::answer.
    void answer(double level, bool yes);
    /// All tracks are.
    bool done() const;

    const std::vector<Procedure>& tracks() const { return tracks_; }

  private:
    void draw();

    std::vector<Procedure> tracks_;
    Random random_;
    size_t track_ = 0;
};

}  // namespace dihaptic::experiment
