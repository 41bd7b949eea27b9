#include "rig/calibration_run.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "model/minimum_jerk.h"
#include "rig/guided_steps.h"
#include "rig/workspace.h"

namespace dihaptic::rig {
namespace {

constexpr double kLink = 0.05;      // length of the link [m]
constexpr double kCarry = 60;       // time for which the link is carried [s]
constexpr double kRaise = 1.5;      // time to start from rest, and to return to it [s]
constexpr double kMove = 0.6;       // time to move from one point of the jig to the next [s]
constexpr double kTouch = 0.4;      // time spent on a point of the jig [s]
constexpr double kHold = 1;         // time for which endpoints are held together [s]
constexpr double kSlipping = 0.2;   // duration of a slip [s]
constexpr double kSlips = 0.05;     // fraction of the time during which slips occur
constexpr double kSlipSize = 5e-3;  // largest displacement in a slip [m]
constexpr double kMargin = 0.01;    // distance kept from the limits of the common workspace [m]

/// The impedance of fingers that are as stiff as when they hold a tool.
hand::Impedance firm() {
    hand::Impedance out;
    out.stiffness = 1e5;
    out.damping = 150;
    return out;
}

struct Ball {
    Vec3 centre;
    double radius;  // [m]
};

class CalibrationHand final : public hand::Driver {
  public:
    struct Stretch {
        double start = 0;
        double end = 0;
        size_t device = 0;  // the device that is joined to the first, or that touches the jig
        int point = -1;     // index of the point of the jig; -1 if there is none
        enum class What { link, jig, together } what = What::link;
    };

    CalibrationHand(size_t devices, const Ball& ball, const std::vector<Vec3>& jig, uint64_t seed)
        : ball_(ball), jig_(jig) {
        double t = 0;
        const auto add = [&](double duration, size_t device, int point, auto what) {
            stretches_.push_back({t, t + duration, device, point, what});
            t += duration;
        };
        for (size_t device = 1; device < devices; ++device)
            add(kCarry, device, -1, Stretch::What::link);
        for (size_t device = 0; device < devices; ++device) {
            for (size_t point = 0; point < jig.size(); ++point)
                add(kMove + kTouch, device, static_cast<int>(point), Stretch::What::jig);
            if (!jig.empty())
                add(kMove, device, static_cast<int>(jig.size()),
                    Stretch::What::jig);  // return to the middle
        }
        // fingers are held together in the middle, where all of them wait
        for (size_t device = 1; device < devices; ++device)
            add(kMove + kHold, device, -1, Stretch::What::together);
        duration_ = t;
        Random random(seed, "slips");
        for (double from = 0; from < t; from += kSlipping) {
            const bool slips = random.uniform(0, 1) < kSlips;
            const Vec3 d = Vec3(random.normal(), random.normal(), random.normal()).normalized();
            slips_.push_back(slips ? Vec3(kSlipSize * d) : Vec3(Vec3::Zero()));
        }
    }

    double duration() const override { return duration_; }
    const std::vector<Phase>& phases() const override { return phases_; }
    const Stretch& at(double t) const noexcept {
        size_t i = 0;
        while (i + 1 < stretches_.size() && t >= stretches_[i].end) ++i;
        return stretches_[i];
    }
    bool samples(double t) const noexcept {
        const Stretch& stretch = at(t);
        if (stretch.what == Stretch::What::link)
            return t - stretch.start > kRaise && stretch.end - t > kRaise;
        return t - stretch.start > kMove + 0.1;  // at rest
    }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        constexpr double kStep = 1e-4;
        const auto device = static_cast<size_t>(finger);
        return {place(device, t),
                (place(device, t + kStep) - place(device, t - kStep)) / (2 * kStep)};
    }
    Vec3 place(size_t device, double t) const noexcept {
        const Stretch& now = at(t);
        if (now.point >= 0 && now.device == device) {
            const auto point = static_cast<size_t>(now.point);
            const Vec3 from = point == 0 ? ball_.centre : jig_[point - 1];
            const Vec3 to = point == jig_.size() ? ball_.centre : jig_[point];
            return from + model::minimum_jerk((t - now.start) / kMove).share * (to - from);
        }
        const bool carries =
            now.what == Stretch::What::link && (device == 0 || device == now.device);
        if (!carries) return ball_.centre;
        // the link's movement starts and ends in the middle, where both fingers wait
        const double raised = model::minimum_jerk((t - now.start) / kRaise).share *
                              model::minimum_jerk((now.end - t) / kRaise).share;
        const auto wave = [&](double hertz) { return std::sin(2 * std::numbers::pi * hertz * t); };
        const Vec3 waves(wave(0.11), wave(0.17), wave(0.23));
        const Vec3 off = ball_.radius / std::max(1.0, waves.norm()) * waves;
        const double up = 0.95 * wave(0.13);
        const double around = 2 * std::numbers::pi * 0.29 * t;
        const double level = std::sqrt(1 - up * up);
        const Vec3 along(level * std::cos(around), level * std::sin(around), up);
        if (device == 0) return ball_.centre + raised * (off + kLink / 2 * along);
        const auto slip = static_cast<size_t>(std::max(0.0, t) / kSlipping);
        const double in =
            std::sin(std::numbers::pi * std::fmod(std::max(0.0, t), kSlipping) / kSlipping);
        return ball_.centre + raised * (off - kLink / 2 * along +
                                        in * in * slips_[std::min(slip, slips_.size() - 1)]);
    }

    Ball ball_;
    std::vector<Vec3> jig_;
    std::vector<Stretch> stretches_;
    std::vector<Vec3> slips_;
    std::vector<Phase> phases_;
    double duration_ = 0;
};

std::vector<Vec3> jig_of(const Rig& rig) {
    std::vector<Vec3> out;
    for (const JigPoint& point : rig.jig) out.push_back(point.position);
    return out;
}

std::unique_ptr<devices::DeviceGroup> devices_of(const Rig& rig, const hand::Driver* driver) {
    devices::Context context;
    context.driver = driver;
    context.impedance = firm();
    return make_devices(uncorrected(rig), held_fingers(rig), context);
}

/// The ball within which the link's centre can move, whatever the direction of the link.
Ball common_ball(const Rig& rig) {
    const Workspace found = find_workspace(reaches(rig));
    const Ball ball{found.sphere_centre, found.sphere_radius - kLink / 2 - kMargin};
    if (ball.radius < kLeastDepth / 4) {
        throw Error(rig.place, "devices", "have too small a common reach for carrying a link",
                    "See dihaptic workspace, and move the devices nearer to each other.");
    }
    return ball;
}

}  // namespace

CalibrationSampler::CalibrationSampler(const Rig& rig, const hand::Driver* driver)
    : devices_(devices_of(rig, driver)),
      claims_(claim_devices(rig, held_fingers(rig), *devices_)),
      reader_(*devices_, held_fingers(rig)) {
    for (size_t i = 0; i < rig.devices.size(); ++i) {
        const frame::DeviceInfo& info = devices_->info(static_cast<int>(i));
        input_.devices.push_back(
            {rig.devices[i].finger, info.serial, rig.devices[i].X_WD(), info.arm});
    }
    input_.jig = jig_of(rig);
}

void CalibrationSampler::add_link(size_t other) {
    input_.link_samples.push_back({0, other, reading(0), reading(other)});
}

void CalibrationSampler::add_together(size_t other) {
    input_.together_samples.push_back({0, other, reading(0), reading(other)});
}

double CalibrationSampler::moved_apart(size_t from) const {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (size_t k = from; k < input_.together_samples.size(); ++k) {
        const CalibrationInput::LinkSample& sample = input_.together_samples[k];
        const double apart = (input_.devices[sample.a].X_WD * sample.at_a.p_DH -
                              input_.devices[sample.b].X_WD * sample.at_b.p_DH)
                                 .norm();
        least = std::min(least, apart);
        most = std::max(most, apart);
    }
    return std::max(0.0, most - least);
}

void CalibrationSampler::add_touch(size_t device, size_t point) {
    input_.jig_samples.push_back({device, reading(device), point});
}

Vec3 CalibrationSampler::cloud(size_t device) const {
    std::vector<Vec3> points;
    for (const CalibrationInput::LinkSample& sample : input_.link_samples) {
        if (sample.a == device) points.push_back(sample.at_a.p_DH);
        if (sample.b == device) points.push_back(sample.at_b.p_DH);
    }
    return cloud_extents(points);
}

CalibrationInput simulate_calibration(const Rig& rig, uint64_t seed,
                                      const std::function<bool(double share)>& progress) {
    for (const Device& device : rig.devices) {
        if (device.backend == "simulated") continue;
        throw Error(device.place, "backend", "is not simulated, unlike the first device's",
                    "All devices of a rig must have the same backend.");
    }
    const Rig plain = uncorrected(rig);
    const CalibrationHand hand(rig.devices.size(), common_ball(plain), jig_of(rig), seed);
    CalibrationSampler sampler(rig, &hand);
    sampler.activate();
    const auto end = from_seconds(hand.duration());
    for (Time now{0}; now < end; now += DeviceReader::kTick) {
        sampler.reader().tick(now);
        if (now % GuidedSteps::kEvery != Time(0)) continue;
        if (!progress(seconds(now) / hand.duration())) break;
        if (!hand.samples(seconds(now))) continue;
        const CalibrationHand::Stretch& stretch = hand.at(seconds(now));
        switch (stretch.what) {
            case CalibrationHand::Stretch::What::link:
                sampler.add_link(stretch.device);
                break;
            case CalibrationHand::Stretch::What::together:
                sampler.add_together(stretch.device);
                break;
            case CalibrationHand::Stretch::What::jig:
                sampler.add_touch(stretch.device, static_cast<size_t>(stretch.point));
        }
    }
    sampler.deactivate();
    return sampler.input();
}

}  // namespace dihaptic::rig
