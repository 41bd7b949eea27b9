#include "rig/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/number.h"
#include "base/unit.h"
#include "model/phantom_arm.h"
#include "rig/calibration_solver.h"

namespace dihaptic::rig {
namespace {

constexpr size_t kFolds = 5;
/// Number of stretches of time into which the samples are divided. Whole stretches are held out,
/// because neighbouring samples are nearly equal.
constexpr size_t kStretches = 50;
/// Smallest proportion of the link's directions d along any axis, measured by the smallest
/// eigenvalue of the mean of d d^T, which is 1/3 if the directions are uniformly distributed.
constexpr double kLeastTurned = 0.04;
/// If the spread is larger than this, the endpoints were not joined by a single link [m].
constexpr double kMostSpread = 2e-3;
constexpr double kMostSlips = 0.3;

double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double worst(const std::vector<double>& values) {
    double most = 0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

void check_movement(const CalibrationInput& input, const CalibrationSolver& solver) {
    const std::string again =
        "Move the endpoints, joined, through all of the workspace: far and near, left and right, "
        "up and down.";
    if (input.link_samples.size() < kLeastSamples) {
        throw Error(fmt::format("{} samples are too few; {} are needed", input.link_samples.size(),
                                kLeastSamples),
                    again);
    }
    const CalibrationSolution nominal = solver.nominal();
    std::vector<std::vector<Vec3>> clouds(input.devices.size());
    Mat3 turned = Mat3::Zero();
    for (const CalibrationInput::LinkSample& sample : input.link_samples) {
        const Vec3 a = solver.endpoint(nominal, sample.a, sample.at_a);
        const Vec3 b = solver.endpoint(nominal, sample.b, sample.at_b);
        clouds[sample.a].push_back(a);
        clouds[sample.b].push_back(b);
        const Vec3 d = (a - b).normalized();
        turned += d * d.transpose() / static_cast<double>(input.link_samples.size());
    }
    for (size_t i = 0; i < clouds.size(); ++i) {
        if (clouds[i].empty()) {
            throw Error(
                fmt::format("the {}'s device was joined to no other", input.devices[i].finger),
                "Join each device to the first with the link.");
        }
        const Vec3 extents = cloud_extents(clouds[i]);
        if (extents[0] >= kLeastDepth) continue;
        throw Error(
            fmt::format("the cloud of the {}'s endpoint was {:.0f} x {:.0f} x {:.0f} mm: {:.0f} mm "
                        "deep, but {:.0f} are needed",
                        input.devices[i].finger, extents[2] * 1e3, extents[1] * 1e3,
                        extents[0] * 1e3, extents[0] * 1e3, kLeastDepth * 1e3),
            again);
    }
    const double least = Eigen::SelfAdjointEigenSolver<Mat3>(turned).eigenvalues()[0];
    if (least < kLeastTurned) {
        throw Error(
            "the link pointed nearly the same way all the time, or stayed in one plane",
            "Turn the link while moving it: along the table in all directions, and upright.");
    }
}

/// Throws Error if the joint angles contradict the position that the device reports.
void check_joints(const CalibrationInput& input) {
    constexpr double kMostApart = 2e-3;  // rms [m]
    for (size_t i = 0; i < input.devices.size(); ++i) {
        const auto& arm = input.devices[i].arm;
        if (!arm) continue;
        std::vector<Vec3> apart;
        const auto add = [&](const CalibrationReading& at) {
            apart.push_back(at.p_DH - model::phantom_position(*arm, at.joints));
        };
        for (const auto& sample : input.link_samples) {
            if (sample.a == i) add(sample.at_a);
            if (sample.b == i) add(sample.at_b);
        }
        for (const auto& sample : input.jig_samples) {
            if (sample.device == i) add(sample.at);
        }
        // a constant difference would only move the origin of D
        Vec3 mean = Vec3::Zero();
        for (const Vec3& d : apart) mean += d / static_cast<double>(apart.size());
        std::vector<double> off;
        for (const Vec3& d : apart) off.push_back((d - mean).norm());
        if (rms(off) <= kMostApart) continue;
        throw Error(
            fmt::format("the joint angles of the {}'s device contradict its reported "
                        "position: {:.1f} mm rms, {:.1f} mm at worst",
                        input.devices[i].finger, rms(off) * 1e3, worst(off) * 1e3),
            "Correct the lengths of its links in the rig file (thigh_mm, shin_mm), or leave out "
            "joint_angles.");
    }
}

/// Throws Error if the touched points lie on a line, because the devices' rotation about that line
/// would then be undetermined.
void check_touches(const CalibrationInput& input) {
    std::vector<Vec3> points;
    for (const CalibrationInput::JigSample& sample : input.jig_samples)
        points.push_back(input.jig[sample.point]);
    if (across(points) >= kLeastJig) return;
    throw Error(
        "the touched points of the jig are on a line, or too near to each other",
        fmt::format("Touch three or more, {:.0f} mm apart in two directions.", kLeastJig * 1e3));
}

void check_link(const CalibrationSolution& solution, double slips) {
    if (solution.link_spread <= kMostSpread && slips <= kMostSlips) return;
    throw Error(
        fmt::format("the endpoints were not held by one link: its length varied by {:.1f} mm, and "
                    "{:.0f} % of the samples were slips",
                    solution.link_spread * 1e3, slips * 100),
        "Fasten the link to both endpoints, and move them again. If it was fastened, check that "
        "the rig file's position, rotation, backend and links fit these devices.");
}

/// Returns for each sample 1 if it is used for fitting a fold, and 0 if it is held out.
std::vector<uint8_t> without(size_t count, size_t fold, size_t stretches) {
    std::vector<uint8_t> use(count, 1);
    for (size_t k = 0; k < count; ++k) use[k] = k * stretches / count % kFolds != fold;
    return use;
}

DeviceCalibration part_of(const CalibrationInput::Device& device, const Correction& correction) {
    DeviceCalibration out;
    out.finger = device.finger;
    out.serial = device.serial;
    out.shift = correction.X.p;
    out.turn = angles_xyz(correction.X.R);
    if (correction.arm) {
        out.joint_offset = correction.joint_offset;
        return out;
    }
    const Mat3& S = correction.stretch;
    out.stretch = S.diagonal();
    out.skew = {S(1, 2), S(0, 2), S(0, 1)};
    return out;
}

/// Mean distance between the endpoints of a device and the first device when they were held
/// together [m].
std::optional<double> together(const CalibrationInput& input, const CalibrationSolver& solver,
                               const CalibrationSolution& solution, size_t device) {
    double sum = 0;
    int count = 0;
    for (const CalibrationInput::LinkSample& sample : input.together_samples) {
        if (sample.b != device) continue;
        sum += (solver.endpoint(solution, sample.a, sample.at_a) -
                solver.endpoint(solution, sample.b, sample.at_b))
                   .norm();
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
}

Vec3 middle(const CalibrationSolver& solver, const CalibrationSolution& solution,
            const CalibrationInput::LinkSample& sample) {
    return (solver.endpoint(solution, sample.a, sample.at_a) +
            solver.endpoint(solution, sample.b, sample.at_b)) /
           2;
}

/// Misfits of the samples that were not used for the solution.
struct HeldOut {
    std::vector<double> along_link;  ///< misfits along the link, without slips [m]
    std::vector<double> off_jig;     ///< distances from the jig's points, without slips [m]
    size_t slips = 0;                ///< number of slips among the link's samples
};

/// Solves again for each fold without the samples of that fold, and evaluates these samples with
/// the solution. `all` is the solution from all samples. The residuals of the link's samples are
/// stored in `out`.
HeldOut judge_held_out(const CalibrationInput& input, const CalibrationSolver& solver,
                       const CalibrationSolution& all, CalibrationResult& out) {
    const size_t links = input.link_samples.size();
    const size_t touches = input.jig_samples.size();
    HeldOut found;
    out.after.resize(links);
    for (size_t fold = 0; fold < kFolds; ++fold) {
        const auto link = without(links, fold, kStretches);
        auto jig = std::vector<uint8_t>(touches, 1);
        // all samples of a touched point are held out together, because they are nearly equal
        for (size_t k = 0; k < touches; ++k) jig[k] = input.jig_samples[k].point % kFolds != fold;
        const CalibrationSolution part = solver.solve(all, link, jig);
        for (size_t k = 0; k < links; ++k) {
            if (link[k]) continue;
            const CalibrationInput::LinkSample& sample = input.link_samples[k];
            const double misfit = solver.link_misfit(part, sample);
            const bool slip = std::abs(misfit) > kSlip * all.link_spread;
            out.after[k] = {middle(solver, part, sample), misfit, slip};
            out.before[k].slip = slip;
            found.slips += slip;
            if (!slip) found.along_link.push_back(misfit);
        }
        for (size_t k = 0; k < touches; ++k) {
            if (jig[k]) continue;
            const double misfit = solver.jig_misfit(part, input.jig_samples[k]).norm();
            if (misfit <= 2 * kSlip * all.jig_spread) found.off_jig.push_back(misfit);
        }
    }
    return found;
}

}  // namespace

Correction DeviceCalibration::correction(const std::optional<model::PhantomLinks>& arm) const {
    Correction out;
    out.X = {rotation_xyz(turn), shift};
    if (joint_offset) {
        out.arm = arm;
        out.joint_offset = *joint_offset;
    }
    out.stretch << stretch.x(), skew.z(), skew.y(), skew.z(), stretch.y(), skew.x(), skew.y(),
        skew.x(), stretch.z();
    return out;
}

const DeviceCalibration* Calibration::find(const std::string& finger) const {
    const auto found = std::find_if(devices.begin(), devices.end(),
                                    [&](const DeviceCalibration& d) { return d.finger == finger; });
    return found == devices.end() ? nullptr : &*found;
}

std::optional<int> days_between(const std::string& from, const std::string& to) {
    const auto day = [](const std::string& text) -> std::optional<std::chrono::sys_days> {
        if (text.size() < 10 || text[4] != '-' || text[7] != '-') return {};
        const std::string_view digits = text;
        const auto y = whole_number<int>(digits.substr(0, 4));
        const auto m = whole_number<unsigned>(digits.substr(5, 2));
        const auto d = whole_number<unsigned>(digits.substr(8, 2));
        if (!y || !m || !d) return {};
        const std::chrono::year_month_day date{std::chrono::year(*y), std::chrono::month(*m),
                                               std::chrono::day(*d)};
        if (!date.ok()) return {};
        return std::chrono::sys_days(date);
    };
    const auto first = day(from);
    const auto last = day(to);
    if (!first || !last) return {};
    return static_cast<int>((*last - *first).count());
}

Vec3 cloud_extents(const std::vector<Vec3>& points) {
    if (points.empty()) return Vec3::Zero();
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    Mat3 spread = Mat3::Zero();
    for (const Vec3& p : points) spread += (p - mean) * (p - mean).transpose();
    const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
    Vec3 out;
    std::vector<double> along(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (size_t k = 0; k < points.size(); ++k) along[k] = axes.col(axis).dot(points[k] - mean);
        std::sort(along.begin(), along.end());
        const size_t outer = points.size() / 100;
        out[axis] = along[points.size() - 1 - outer] - along[outer];
    }
    std::sort(out.begin(), out.end());
    return out;
}

double across(const std::vector<Vec3>& points) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    Mat3 spread = Mat3::Zero();
    for (const Vec3& p : points)
        spread += (p - mean) * (p - mean).transpose() / static_cast<double>(points.size());
    const Vec3 variance = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvalues();
    return 2 * std::sqrt(std::max(0.0, variance[1]));
}

CalibrationResult calibrate(const CalibrationInput& input) {
    check_joints(input);  // checked first, because wrong link lengths make a cloud look too small
    const CalibrationSolver solver(input);
    if (input.devices.size() > 1) {
        check_movement(input, solver);
    } else if (input.jig_samples.empty()) {
        throw Error("a single device is calibrated with a jig, but no jig was touched",
                    "Give the rig file a jig, or two devices.");
    }
    if (!input.jig_samples.empty()) check_touches(input);
    const size_t links = input.link_samples.size();
    const size_t touches = input.jig_samples.size();
    const CalibrationSolution nominal = solver.nominal();
    const CalibrationSolution all =
        solver.solve(nominal, std::vector<uint8_t>(links, 1), std::vector<uint8_t>(touches, 1));

    CalibrationResult out;
    for (const CalibrationInput::LinkSample& sample : input.link_samples)
        out.before.push_back(
            {middle(solver, nominal, sample), solver.link_misfit(nominal, sample)});
    const HeldOut held_out = judge_held_out(input, solver, all, out);
    Calibration& calibration = out.calibration;
    if (links > 0)
        calibration.slips = static_cast<double>(held_out.slips) / static_cast<double>(links);
    check_link(all, calibration.slips);
    if (all.jig_spread > kMostSpread) {
        throw Error(fmt::format("the endpoints that touched the jig were {:.1f} mm from its points",
                                all.jig_spread * 1e3),
                    "Check that the rig file's jig, positions and rotations agree with reality.");
    }
    calibration.link_length = all.length;
    calibration.link_rms = rms(held_out.along_link);
    calibration.link_worst = worst(held_out.along_link);
    // the link shows one of three directions at a time, and each of them equally often
    calibration.agreement_rms = std::sqrt(3.0) * calibration.link_rms;
    if (touches > 0) {
        calibration.jig_rms = rms(held_out.off_jig);
        calibration.jig_worst = worst(held_out.off_jig);
    }
    for (size_t i = 0; i < input.devices.size(); ++i) {
        calibration.devices.push_back(part_of(input.devices[i], all.corrections[i]));
        calibration.devices.back().together = together(input, solver, all, i);
    }
    return out;
}

std::string describe(const CalibrationResult& result) {
    const Calibration& c = result.calibration;
    const auto mm = [](double metres) { return metres * 1e3; };
    std::string out;
    if (!result.before.empty()) {
        std::vector<double> before;
        for (const LinkResidual& r : result.before) {
            if (!r.slip) before.push_back(r.misfit);
        }
        out += fmt::format(
            "link of {:.2f} mm, misfit along it, in held-out samples:\n"
            "  before  {:7.3f} mm rms\n"
            "  after   {:7.3f} mm rms, {:.3f} mm at worst; {:.1f} % of the samples were slips\n"
            "endpoints agree to {:.3f} mm rms in space\n",
            mm(c.link_length), mm(rms(before)), mm(c.link_rms), mm(c.link_worst), c.slips * 100,
            mm(c.agreement_rms));
    }
    if (c.jig_rms) {
        out += fmt::format("jig: {:.3f} mm rms, {:.3f} mm at worst\n", mm(*c.jig_rms),
                           mm(*c.jig_worst));
    } else {
        out += "no jig: the world remains as in the rig file\n";
    }
    for (const DeviceCalibration& d : c.devices) {
        out +=
            fmt::format("{:8} shift [{:.2f}, {:.2f}, {:.2f}] mm, turn [{:.2f}, {:.2f}, {:.2f}] deg",
                        d.finger, mm(d.shift.x()), mm(d.shift.y()), mm(d.shift.z()),
                        d.turn.x() / kDegree, d.turn.y() / kDegree, d.turn.z() / kDegree);
        if (d.joint_offset) {
            out += fmt::format(", joints {:.2f} and {:.2f} deg", d.joint_offset->y() / kDegree,
                               d.joint_offset->z() / kDegree);
        } else {
            out += fmt::format(
                ", stretch [{:.4f}, {:.4f}, {:.4f}]; without joint angles, distortions of its "
                "space "
                "remain",
                d.stretch.x(), d.stretch.y(), d.stretch.z());
        }
        if (d.together)
            out += fmt::format("; {:.1f} mm from the first, when held together", mm(*d.together));
        out += "\n";
    }
    return out;
}

}  // namespace dihaptic::rig
