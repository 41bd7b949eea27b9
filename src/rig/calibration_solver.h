// Robust least squares for a calibration (README.md): Gauss-Newton steps on
//
//     sum over link samples  rho((|p_a - p_b| - L) / s_link)
//   + sum over jig samples   rho(|p - q| / s_jig)
//   + sum over parameters    (value / prior)^2
//
// with p the corrected endpoint in the world. Steps are weighted, first by Huber's rho, which finds
// the way, then by Tukey's, which gives slips no say; s follows from the median misfit. The prior
// is far wider than any fault: it decides only what the samples leave open.
#pragma once

#include <vector>

#include "rig/calibration.h"

namespace dihaptic::rig {

struct CalibrationSolution {
    std::vector<Correction> corrections;  ///< by device
    double length = 0;                    ///< L [m]
    double link_spread = 0;               ///< s_link [m]
    double jig_spread = 0;                ///< s_jig [m]
};

/// What weighs nothing any more, over s.
constexpr double kSlip = 4.685;

class CalibrationSolver {
  public:
    explicit CalibrationSolver(const CalibrationInput& input);

    /// As the rig file has it, with the median distance for L.
    CalibrationSolution nominal() const;
    /// `link`, `jig`: which samples are used, 1 each.
    CalibrationSolution solve(CalibrationSolution start, const std::vector<uint8_t>& link,
                              const std::vector<uint8_t>& jig) const;

    /// p in the world [m].
    Vec3 endpoint(const CalibrationSolution& solution, size_t device,
                  const CalibrationReading& at) const;
    /// |p_a - p_b| - L [m].
    double link_misfit(const CalibrationSolution& solution,
                       const CalibrationInput::LinkSample& sample) const;
    /// p - q [m].
    Vec3 jig_misfit(const CalibrationSolution& solution,
                    const CalibrationInput::JigSample& sample) const;

  private:
    struct Step;
    double step(CalibrationSolution& solution, const std::vector<uint8_t>& link,
                const std::vector<uint8_t>& jig, bool redescending) const;
    size_t shape_count(size_t device) const { return input_.devices[device].arm ? 2 : 6; }

    const CalibrationInput& input_;
    std::vector<size_t> first_;  // of each device's parameters
    size_t count_ = 0;           // of all of them, L the last
};

}  // namespace dihaptic::rig
