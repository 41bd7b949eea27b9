#include "rig/calibration_run.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dihaptic::rig::calibration_run_test {
namespace {

const auto kGoOn = [](double) { return true; };

Rig misplaced() {
    Diagnostics diagnostics;
    Rig rig = read_rig("rigs/premium-misplaced.yaml", diagnostics);
    diagnostics.throw_if_errors();
    return rig;
}

/// A simulated hand that holds the endpoints together and moves them about.
class TogetherDriver final : public hand::Driver {
  public:
    static Vec3 at(double t) {
        return Vec3(0.045 * std::sin(2.1 * t), 0.045 * std::cos(2.9 * t),
                    0.07 + 0.045 * std::sin(3.7 * t));
    }
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        constexpr double kStep = 1e-5;
        return {at(t), (at(t + kStep) - at(t - kStep)) / (2 * kStep)};
    }
    std::vector<Phase> phases_;
};

/// The distance that devices report between endpoints that a hand holds together [m].
struct Apart {
    double rms = 0;
    double worst = 0;
};
Apart apart(const Rig& rig) {
    const TogetherDriver driver;
    devices::Context context;
    context.driver = &driver;
    context.impedance.stiffness = 1e5;
    context.impedance.damping = 150;
    const std::vector<std::string> fingers{"thumb", "index"};
    const auto group = make_devices(rig, fingers, context);
    const auto X_WD = poses(rig, fingers);
    std::vector<devices::Reading> readings(2);
    const std::vector<Wrench> none(2);
    group->activate();
    Apart out;
    constexpr int kTicks = 10000;
    for (int i = 0; i < kTicks; ++i) {
        group->read(i * std::chrono::milliseconds(1), readings);
        group->write(none);
        const double off = (X_WD[0] * readings[0].p_DH - X_WD[1] * readings[1].p_DH).norm();
        out.rms += off * off / kTicks;
        out.worst = std::max(out.worst, off);
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

TEST(CalibrationRun, OfSimulatedPremiumsBringsTheirEndpointsTogether) {
    Rig rig = misplaced();
    const Apart before = apart(rig);
    EXPECT_GT(before.rms, 2e-3);
    const CalibrationInput input = simulate_calibration(rig, 1, kGoOn);
    EXPECT_GT(input.link_samples.size(), 2000U);
    EXPECT_GT(input.jig_samples.size(), 100U);
    const CalibrationResult result = calibrate(input);
    EXPECT_GT(result.calibration.slips, 0.01);
    EXPECT_LT(result.calibration.slips, 0.08);
    EXPECT_EQ(result.calibration.find("index")->serial, "2");
    rig.calibrated = result.calibration;
    const Apart after = apart(rig);
    EXPECT_LT(after.rms, 0.1e-3);
    EXPECT_LT(after.worst, 0.3e-3);
    EXPECT_NEAR(result.calibration.agreement_rms / after.rms, 1, 0.4);
    RecordProperty("after_um", number_text(after.rms * 1e6));

    const std::string svg = residual_picture(result, "two <Premiums>");
    for (const char* words : {"two &lt;Premiums&gt;", "as in the rig file", "held-out", "50 mm"})
        EXPECT_NE(svg.find(words), std::string::npos) << words;
}

TEST(CalibrationRun, CanBeGivenUp) {
    int calls = 0;
    simulate_calibration(misplaced(), 1, [&](double) { return ++calls < 3; });
    EXPECT_EQ(calls, 3);
}

TEST(CalibrationRun, NeedsSimulatedDevicesForASimulatedHand) {
    Rig rig = misplaced();
    rig.devices[1].backend = "replay";
    EXPECT_THROW(simulate_calibration(rig, 1, kGoOn), Error);
}

}  // namespace
}  // namespace dihaptic::rig::calibration_run_test
