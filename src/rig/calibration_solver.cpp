#include "rig/calibration_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/statistics.h"

namespace dihaptic::rig {
namespace {

using Gradient = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 12>;

// standard deviations of the priors for a rig's faults
constexpr double kTurn = 0.2;    // [rad]
constexpr double kShift = 0.05;  // [m]
constexpr double kOffset = 0.2;  // [rad]
constexpr double kStretch = 0.1;
constexpr double kLeastSpread = 2e-6;  // smaller than the resolution of any device's encoders [m]
constexpr int kHuberSteps = 12;
constexpr int kMostSteps = 80;

/// Weight of a misfit; `ratio` is the misfit divided by the spread. Uses Tukey's function if
/// `redescending`, and Huber's otherwise.
double weight(double ratio, bool redescending) {
    constexpr double kHuber = 1.345;
    if (!redescending) return std::abs(ratio) <= kHuber ? 1 : kHuber / std::abs(ratio);
    if (std::abs(ratio) >= kSlip) return 0;
    const double rest = 1 - ratio * ratio / (kSlip * kSlip);
    return rest * rest;
}

Mat3 cross_matrix(const Vec3& v) {
    Mat3 out;
    out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return out;
}

/// Returns the symmetric matrix S with the elements xx, yy, zz, yz, xz, xy.
Mat3 symmetric(const Eigen::Ref<const Eigen::VectorXd>& s) {
    Mat3 out;
    out << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    return out;
}

}  // namespace

CalibrationSolver::CalibrationSolver(const CalibrationInput& input) : input_(input) {
    for (size_t i = 0; i < input.devices.size(); ++i) {
        first_.push_back(count_);
        count_ += 6 + shape_count(i);
    }
    ++count_;
}

CalibrationSolution CalibrationSolver::nominal() const {
    CalibrationSolution out;
    for (const CalibrationInput::Device& device : input_.devices) {
        out.corrections.emplace_back();
        out.corrections.back().arm = device.arm;
    }
    std::vector<double> distances;
    for (const CalibrationInput::LinkSample& sample : input_.link_samples)
        distances.push_back(link_misfit(out, sample));
    if (!distances.empty()) out.length = quantile(distances, 0.5);
    return out;
}

Vec3 CalibrationSolver::endpoint(const CalibrationSolution& solution, size_t device,
                                 const CalibrationReading& at) const {
    return input_.devices[device].X_WD * solution.corrections[device].position(at.p_DH, at.joints);
}

double CalibrationSolver::link_misfit(const CalibrationSolution& solution,
                                      const CalibrationInput::LinkSample& sample) const {
    return (endpoint(solution, sample.a, sample.at_a) - endpoint(solution, sample.b, sample.at_b))
               .norm() -
           solution.length;
}

Vec3 CalibrationSolver::jig_misfit(const CalibrationSolution& solution,
                                   const CalibrationInput::JigSample& sample) const {
    return endpoint(solution, sample.device, sample.at) - input_.jig[sample.point];
}

/// One Gauss-Newton step: sums up the normal equations H change = -g and solves them.
struct CalibrationSolver::Step {
    Step(const CalibrationSolver& of, CalibrationSolution& from, bool is_redescending)
        : solver(of),
          solution(from),
          redescending(is_redescending),
          n(static_cast<Eigen::Index>(of.count_)),
          H(Eigen::MatrixXd::Zero(n, n)),
          g(Eigen::VectorXd::Zero(n)) {}

    Eigen::Index first_of(size_t device) const {
        return static_cast<Eigen::Index>(solver.first_[device]);
    }

    /// Derivative of an endpoint with respect to the parameters of its device: turn, shift and
    /// shape.
    Gradient slope(size_t device, const CalibrationReading& reading) const {
        const Correction& correction = solution.corrections[device];
        Gradient out(3, static_cast<Eigen::Index>(6 + solver.shape_count(device)));
        const Mat3 R = correction.X.R.toRotationMatrix();
        out.leftCols<3>() = -cross_matrix(R * correction.shaped(reading.p_DH, reading.joints));
        out.middleCols<3>(3) = Mat3::Identity();
        if (correction.arm) {
            out.rightCols<2>() = R * model::phantom_jacobian(
                                         *correction.arm, reading.joints + correction.joint_offset)
                                         .rightCols<2>();
        } else {
            for (int i = 0; i < 6; ++i) {
                Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Unit(i);
                out.col(6 + i) = R * symmetric(unit) * reading.p_DH;
            }
        }
        return Gradient(solver.input_.devices[device].X_WD.R.toRotationMatrix() * out);
    }

    void measure_spreads(const std::vector<uint8_t>& link, const std::vector<uint8_t>& jig) {
        std::vector<double> misfits;
        for (size_t k = 0; k < link.size(); ++k)
            if (link[k])
                misfits.push_back(
                    std::abs(solver.link_misfit(solution, solver.input_.link_samples[k])));
        // 0.6745 and 1.538 are the medians of the magnitude of a standard normal variable in one
        // and three dimensions
        solution.link_spread = std::max(kLeastSpread, quantile(misfits, 0.5) / 0.6745);
        misfits.clear();
        for (size_t k = 0; k < jig.size(); ++k)
            if (jig[k])
                misfits.push_back(solver.jig_misfit(solution, solver.input_.jig_samples[k]).norm());
        solution.jig_spread = std::max(kLeastSpread, quantile(misfits, 0.5) / 1.538);
    }

    void add(const CalibrationInput::LinkSample& sample) {
        const double misfit = solver.link_misfit(solution, sample);
        const double w = weight(misfit / solution.link_spread, redescending) /
                         (solution.link_spread * solution.link_spread);
        if (w == 0) return;
        const Vec3 along = (solver.endpoint(solution, sample.a, sample.at_a) -
                            solver.endpoint(solution, sample.b, sample.at_b))
                               .normalized();
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n);
        const Gradient a = slope(sample.a, sample.at_a);
        const Gradient b = slope(sample.b, sample.at_b);
        row.segment(first_of(sample.a), a.cols()) += along.transpose() * a;
        row.segment(first_of(sample.b), b.cols()) -= along.transpose() * b;
        row[n - 1] = -1;
        H.selfadjointView<Eigen::Lower>().rankUpdate(row.transpose(), w);
        g += w * misfit * row.transpose();
    }

    void add(const CalibrationInput::JigSample& sample) {
        const Vec3 misfit = solver.jig_misfit(solution, sample);
        const double w = weight(misfit.norm() / solution.jig_spread, redescending) /
                         (solution.jig_spread * solution.jig_spread);
        const Gradient a = slope(sample.device, sample.at);
        const Eigen::Index i = first_of(sample.device);
        H.block(i, i, a.cols(), a.cols()) += w * a.transpose() * a;
        g.segment(i, a.cols()) += w * a.transpose() * misfit;
    }

    void expect(Eigen::Index i, double value, double prior) {
        H(i, i) += 1 / (prior * prior);
        g[i] += value / (prior * prior);
    }

    void add_priors() {
        for (size_t device = 0; device < solution.corrections.size(); ++device) {
            const Correction& correction = solution.corrections[device];
            const Vec3 turn = rotation_vector(correction.X.R);
            const Eigen::Index i = first_of(device);
            for (int axis = 0; axis < 3; ++axis) {
                expect(i + axis, turn[axis], kTurn);
                expect(i + 3 + axis, correction.X.p[axis], kShift);
            }
            if (correction.arm) {
                expect(i + 6, correction.joint_offset[1], kOffset);
                expect(i + 7, correction.joint_offset[2], kOffset);
                continue;
            }
            const Mat3& S = correction.stretch;
            const std::array<double, 6> shape{S(0, 0), S(1, 1), S(2, 2), S(1, 2), S(0, 2), S(0, 1)};
            for (size_t j = 0; j < shape.size(); ++j)
                expect(i + 6 + static_cast<Eigen::Index>(j), shape[j], kStretch);
        }
        H(n - 1, n - 1) += 1;  // L has a prior of 1 m, so that H has an inverse even without a link
    }

    /// Applies the change to the parameters. Returns the largest change of any parameter.
    double change_parameters() {
        const Eigen::VectorXd change = -H.ldlt().solve(g);
        for (size_t device = 0; device < solution.corrections.size(); ++device) {
            Correction& correction = solution.corrections[device];
            const Eigen::Index i = first_of(device);
            correction.X.R = (rotation_by(change.segment<3>(i)) * correction.X.R).normalized();
            correction.X.p += change.segment<3>(i + 3);
            if (correction.arm) {
                correction.joint_offset.tail<2>() += change.segment<2>(i + 6);
            } else {
                correction.stretch += symmetric(change.segment<6>(i + 6));
            }
        }
        solution.length += change[n - 1];
        return change.cwiseAbs().maxCoeff();
    }

    const CalibrationSolver& solver;
    CalibrationSolution& solution;
    bool redescending;
    Eigen::Index n;
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
};

double CalibrationSolver::step(CalibrationSolution& solution, const std::vector<uint8_t>& link,
                               const std::vector<uint8_t>& jig, bool redescending) const {
    Step step(*this, solution, redescending);
    step.measure_spreads(link, jig);
    for (size_t k = 0; k < link.size(); ++k) {
        if (link[k]) step.add(input_.link_samples[k]);
    }
    for (size_t k = 0; k < jig.size(); ++k) {
        if (jig[k]) step.add(input_.jig_samples[k]);
    }
    // for the link's samples, add() filled only the lower half
    step.H = Eigen::MatrixXd(step.H.selfadjointView<Eigen::Lower>());
    step.add_priors();
    return step.change_parameters();
}

CalibrationSolution CalibrationSolver::solve(CalibrationSolution start,
                                             const std::vector<uint8_t>& link,
                                             const std::vector<uint8_t>& jig) const {
    constexpr double kDone = 1e-8;  // largest change of a parameter in the last step [m, rad]
    for (int i = 0; i < kHuberSteps; ++i) {
        if (step(start, link, jig, false) < kDone) break;
    }
    for (int i = 0; i < kMostSteps; ++i) {
        if (step(start, link, jig, true) < kDone) break;
    }
    return start;
}

}  // namespace dihaptic::rig
