#include "rig/calibration_guide.h"

#include <fmt/format.h>

#include <algorithm>

#include "rig/guided_steps.h"

namespace dihaptic::rig {
namespace {

constexpr uint64_t kSeed = 1;        // seed for the slips of the simulated hand
constexpr int kTouches = 25;         // number of samples for each point of the jig
constexpr int kHeld = 50;            // number of samples of endpoints held together: one second
constexpr double kMostMoved = 2e-3;  // largest allowed change of their distance [m]

class CalibrationWay {
  public:
    CalibrationWay(const Rig& rig, const Guide& guide)
        : rig_(rig), sampler_(rig, nullptr), steps_(sampler_.reader(), guide, count(rig)) {}

    CalibrationInput lead() {
        steps_.begin_step(
            "Hold each arm in the standard configuration: both links at right angles, the thigh "
            "level, the shin hanging. Let it rest on a block that keeps it there: any error here "
            "affects all positions. Leave devices without an arm in their rest positions.");
        steps_.wait();
        sampler_.activate();
        for (size_t other = 1; other < rig_.devices.size(); ++other) carry(other);
        for (size_t device = 0; device < rig_.devices.size(); ++device) touch(device);
        for (size_t other = 1; other < rig_.devices.size(); ++other) hold(other);
        sampler_.deactivate();
        return sampler_.input();
    }

  private:
    static int count(const Rig& rig) {
        const auto devices = static_cast<int>(rig.devices.size());
        return 1 + 3 * (devices - 1) + devices * static_cast<int>(rig.jig.size());
    }
    std::string pair(size_t other) const {
        return fmt::format("{} and {}", rig_.devices[0].finger, rig_.devices[other].finger);
    }
    void carry(size_t other) {
        steps_.begin_step(
            fmt::format("Join the endpoints of {} with the link, and fasten it.", pair(other)));
        steps_.wait();
        steps_.begin_step(
            "Move the link through all of the workspace, turning it in all directions, for a "
            "minute.");
        size_t taken = 0;
        bool too_soon = false;
        steps_.sample([&](bool said) {
            sampler_.add_link(other);
            if (++taken % 25 != 0 && !said) return true;
            const double depth = std::min(sampler_.cloud(0)[0], sampler_.cloud(other)[0]);
            const double share =
                std::min({1.0, depth / kLeastDepth, static_cast<double>(taken) / kLeastSamples});
            too_soon = too_soon || said;
            steps_.tell(share,
                        fmt::format("{:.0f} mm deep, {:.0f} needed; {} samples{}", depth * 1e3,
                                    kLeastDepth * 1e3, taken,
                                    too_soon && share < 1 ? ": continue, that is not enough" : ""));
            return !said || share < 1;
        });
    }
    void touch(size_t device) {
        for (size_t point = 0; point < rig_.jig.size(); ++point) {
            steps_.begin_step(
                fmt::format("Touch '{}' of the jig with the {}'s endpoint, and keep it "
                            "there.",
                            rig_.jig[point].name, rig_.devices[device].finger));
            steps_.wait();
            int taken = 0;
            steps_.sample([&](bool) {
                sampler_.add_touch(device, point);
                return ++taken < kTouches;
            });
        }
    }
    void hold(size_t other) {
        steps_.begin_step(fmt::format(
            "Remove the link. Hold the endpoints of {} together, as at each session's start.",
            pair(other)));
        while (true) {
            steps_.wait();
            const size_t from = sampler_.input().together_samples.size();
            int taken = 0;
            steps_.sample([&](bool) {
                sampler_.add_together(other);
                return ++taken < kHeld;
            });
            const double moved = sampler_.moved_apart(from);
            if (moved <= kMostMoved) return;
            sampler_.forget_together(from);
            steps_.tell(
                0, fmt::format("They moved by {:.1f} mm: hold them still once more.", moved * 1e3));
        }
    }

    const Rig& rig_;
    CalibrationSampler sampler_;
    GuidedSteps steps_;
};

/// Two endpoints whose distance when held together is given by the calibration.
struct Told {
    size_t first;   // finger
    size_t other;   // finger
    double before;  // distance [m]
};

std::vector<Told> told_together(const Rig& rig, const std::vector<std::string>& fingers) {
    std::vector<Told> out;
    if (!rig.calibrated) return out;
    const auto first = std::find(fingers.begin(), fingers.end(), rig.devices.front().finger);
    if (first == fingers.end()) return out;
    for (size_t other = 0; other < fingers.size(); ++other) {
        const DeviceCalibration* const part = rig.calibrated->find(fingers[other]);
        if (part == nullptr || !part->together) continue;
        out.push_back({static_cast<size_t>(first - fingers.begin()), other, *part->together});
    }
    return out;
}

}  // namespace

CalibrationInput lead_calibration(const Rig& rig, const Guide& guide) {
    check_jig(rig);
    if (is_real(rig)) return CalibrationWay(rig, guide).lead();
    Guidance now;
    now.text = "A simulated hand carries the link, and touches the jig.";
    guide.show(now);
    return simulate_calibration(rig, kSeed, [&](double share) {
        now.share = share;
        guide.show(now);
        guide.done();  // throws if the person has cancelled
        return true;
    });
}

bool can_check_together(const Rig& rig, const std::vector<std::string>& fingers) {
    return is_real(rig) && !told_together(rig, fingers).empty();
}

std::string Together::describe() const {
    return fmt::format(
        "the endpoints of {} and {}, held together, are {:.1f} mm apart, but were {:.1f} mm apart "
        "when the rig was calibrated",
        first, second, apart * 1e3, before * 1e3);
}

Problem Together::warning(const Rig& rig) const {
    return {Severity::warning, rig.calibrated->place, "together", describe(),
            "Calibrate the rig again: dihaptic calibrate."};
}

std::vector<Together> check_together(const Rig& rig, const std::vector<std::string>& fingers,
                                     devices::DeviceGroup& devices, const Guide& guide) {
    std::vector<Told> told = told_together(rig, fingers);
    DeviceReader reader(devices, fingers);
    const std::vector<Pose> X_WD = poses(rig, fingers);
    // scales are left out, because they would separate endpoints that are together in the hand
    const auto p_W = [&](size_t k) {
        return Vec3(X_WD[k] *
                    (reader.readings()[k].p_DH / devices.info(static_cast<int>(k)).scale));
    };
    GuidedSteps steps(reader, guide, static_cast<int>(told.size()));
    std::vector<Together> out;
    for (const auto& [first, other, before] : told) {
        Together& pair = out.emplace_back();
        pair.first = fingers[first];
        pair.second = fingers[other];
        pair.before = before;
        steps.begin_step(
            fmt::format("Hold the endpoints of {} and {} together.", pair.first, pair.second));
        steps.wait();
        int taken = 0;
        steps.sample([&, a = first, b = other](bool) {
            pair.apart += (p_W(a) - p_W(b)).norm() / kHeld;
            return ++taken < kHeld;
        });
        pair.agrees = std::abs(pair.apart - pair.before) <=
                      Together::kMostApart + 3 * rig.calibrated->agreement_rms;
    }
    return out;
}

}  // namespace dihaptic::rig
