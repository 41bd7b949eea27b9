// The calibration's robust least squares (README.md): Gauss-Newton steps on
//
//     sum over link samples  rho((|p_a - p_b| - L) / s_link)
//   + sum over jig samples   rho(|p - q| / s_jig)
//   + sum over parameters    (value / prior)^2
//
// where p is the corrected endpoint in the world, q is the jig's point and L is the link's length.
// The weights are first those of Huber's rho, which converges from far away, and then those of
// Tukey's, which gives slips no weight; s is computed from the median misfit. The prior is far
// wider than any fault of a rig, so it affects only parameters that the samples leave undetermined.
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

/// Ratio of misfit to s above which a sample counts as a slip and has no weight (Tukey's constant).
constexpr double kSlip = 4.685;

class CalibrationSolver {
  public:
    explicit CalibrationSolver(const CalibrationInput& input);

    /// The solution without corrections, with the median distance as L.
    CalibrationSolution nominal() const;
    /// Solves from the solution `start`. `link` and `jig` have an entry for each sample: 1 if the
    /// sample is used.
    CalibrationSolution solve(CalibrationSolution start, const std::vector<uint8_t>& link,
                              const std::vector<uint8_t>& jig) const;

    /// The corrected endpoint p in the world [m].
    Vec3 endpoint(const CalibrationSolution& solution, size_t device,
                  const CalibrationReading& at) const;
    /// Misfit of a link sample: |p_a - p_b| - L [m].
    double link_misfit(const CalibrationSolution& solution,
                       const CalibrationInput::LinkSample& sample) const;
    /// Misfit of a jig sample: p - q [m].
    Vec3 jig_misfit(const CalibrationSolution& solution,
                    const CalibrationInput::JigSample& sample) const;

  private:
    struct Step;
    double step(CalibrationSolution& solution, const std::vector<uint8_t>& link,
                const std::vector<uint8_t>& jig, bool redescending) const;
    size_t shape_count(size_t device) const { return input_.devices[device].arm ? 2 : 6; }

    const CalibrationInput& input_;
    std::vector<size_t> first_;  // index of each device's first parameter
    size_t count_ = 0;           // number of parameters, of which L is the last
};

}  // namespace dihaptic::rig
