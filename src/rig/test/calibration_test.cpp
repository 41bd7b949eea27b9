#include "rig/calibration.h"
#include "base/number.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/field_writer.h"
#include "base/random.h"
#include "base/unit.h"

namespace dihaptic::rig::calibration_test {
namespace {

const model::PhantomLinks kLinks;

/// Two Premiums whose poses and resets differ from those in the rig file.
struct Faulty {
    std::vector<Pose> X_WD;     // pose of D according to the rig file
    std::vector<Pose> true_D;   // pose of the true D in the D of the rig file
    std::vector<Vec3> offsets;  // true minus reported joint angles [rad]
    double step = 0.03e-3;
    bool joints = true;

    explicit Faulty(uint64_t seed = 1) {
        Random random(seed, "faults");
        const auto direction = [&] {
            return Vec3(random.normal(), random.normal(), random.normal()).normalized();
        };
        for (const double around : {90.0, -90.0}) {
            X_WD.push_back({rotation_xyz(Vec3(90, 0, around) * kDegree), {0, 0, 0.07}});
            true_D.push_back({rotation_by(2 * kDegree * direction()), 3e-3 * direction()});
            Vec3 offset;
            for (int i = 0; i < 3; ++i) offset[i] = random.normal() > 0 ? kDegree : -kDegree;
            offsets.push_back(offset);
        }
    }
    /// What a device reports when its endpoint is at p_W.
    CalibrationReading report(size_t i, const Vec3& p_W) const {
        const Vec3 q =
            model::phantom_joints(kLinks, true_D[i].inverse() * (X_WD[i].inverse() * p_W)) -
            offsets[i];
        const double angle = step / kLinks.thigh;
        const Vec3 steps = angle > 0 ? Vec3((q / angle).array().round() * angle) : q;
        return {model::phantom_position(kLinks, steps), joints ? steps : Vec3::Zero()};
    }
    bool reach(const Vec3& p_W) const {
        for (size_t i = 0; i < 2; ++i) {
            const Vec3 p_D = true_D[i].inverse() * (X_WD[i].inverse() * p_W);
            if (!model::phantom_reaches(kLinks, p_D)) return false;
        }
        return true;
    }
    CalibrationInput input() const {
        CalibrationInput out;
        for (size_t i = 0; i < 2; ++i) {
            out.devices.push_back({i == 0 ? "thumb" : "index", "", X_WD[i], {}});
            if (joints) out.devices.back().arm = kLinks;
        }
        return out;
    }
};

/// A random position in the workspace, a box of 120 x 120 x 120 mm around the position of the
/// endpoints in the reset pose.
Vec3 some_place(Random& random) {
    return Vec3(random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06),
                random.uniform(0.01, 0.13));
}

/// Adds samples of a link of 50 mm that is moved about. In a fraction `outliers` of them, the link
/// has slipped by a few millimetres.
void move_link(const Faulty& rig, double outliers, CalibrationInput& input, Vec3 extent = {1, 1, 1},
               size_t count = 2000) {
    Random random(3, "link");
    const Vec3 centre(0, 0, 0.07);
    while (input.link_samples.size() < count) {
        const Vec3 middle = centre + extent.cwiseProduct(some_place(random) - centre);
        const Vec3 d = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        if (!rig.reach(middle + 0.04 * d) || !rig.reach(middle - 0.04 * d)) continue;
        Vec3 slip = Vec3::Zero();
        if (random.uniform(0, 1) < outliers)
            slip = random.uniform(1e-3, 10e-3) *
                   Vec3(random.normal(), random.normal(), random.normal()).normalized();
        input.link_samples.push_back(
            {0, 1, rig.report(0, middle + 0.025 * d + slip), rig.report(1, middle - 0.025 * d)});
    }
}

/// Adds samples of a jig with eight points, each of which is touched ten times by each device.
void touch_jig(const Faulty& rig, CalibrationInput& input, double outliers = 0.05) {
    Random random(4, "jig");
    for (int i = 0; i < 8; ++i)
        input.jig.push_back(Vec3(i & 1 ? 0.04 : -0.04, i & 2 ? 0.04 : -0.04, i & 4 ? 0.1 : 0.03));
    for (size_t device = 0; device < 2; ++device) {
        for (size_t point = 0; point < input.jig.size(); ++point) {
            for (int n = 0; n < 10; ++n) {
                const double off = random.uniform(0, 1) < outliers ? 4e-3 : 5e-6;
                const Vec3 p = input.jig[point] +
                               off * Vec3(random.normal(), random.normal(), random.normal());
                input.jig_samples.push_back({device, rig.report(device, p), point});
            }
        }
    }
}

struct Errors {
    double rms = 0;
    double worst = 0;
    void add(double error) {
        sum += error * error;
        ++count;
        worst = std::max(worst, error);
        rms = std::sqrt(sum / count);
    }

  private:
    double sum = 0;
    int count = 0;
};

struct Judged {
    Errors agreement;  // distances between two endpoints at the same position
    Errors truth;      // distances of each endpoint from that position
};
/// Computes the errors over the workspace, at positions that were not used for the calibration.
Judged judge(const Faulty& rig, const Calibration* calibration) {
    Random random(99, "judge");
    Judged out;
    for (int k = 0; k < 4000; ++k) {
        const Vec3 p_W = some_place(random);
        if (!rig.reach(p_W)) continue;
        Vec3 found[2];
        for (size_t i = 0; i < 2; ++i) {
            const CalibrationReading at = rig.report(i, p_W);
            Correction correction;
            if (calibration != nullptr)
                correction = calibration->devices[i].correction(rig.joints ? std::optional(kLinks)
                                                                           : std::nullopt);
            found[i] = rig.X_WD[i] * correction.position(at.p_DH, at.joints);
            out.truth.add((found[i] - p_W).norm());
        }
        out.agreement.add((found[0] - found[1]).norm());
    }
    return out;
}

/// Records the errors in micrometres, for --gtest_output=json.
void record(uint64_t seed, const Judged& before, const Judged& after, const Calibration& says) {
    const auto um = [&](const char* name, double metres) {
        ::testing::Test::RecordProperty("seed_" + number_text(seed) + "_" + name,
                                        static_cast<int>(std::lround(metres * 1e6)));
    };
    um("before_rms", before.agreement.rms);
    um("before_worst", before.agreement.worst);
    um("after_rms", after.agreement.rms);
    um("after_worst", after.agreement.worst);
    um("says_rms", says.agreement_rms);
    um("says_link_worst", says.link_worst);
}

TEST(Calibration, BringsMisplacedPremiumsTogether) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const Faulty rig(seed);
        CalibrationInput input = rig.input();
        move_link(rig, 0.05, input);
        touch_jig(rig, input);
        const CalibrationResult result = calibrate(input);
        const Judged before = judge(rig, nullptr);
        const Judged after = judge(rig, &result.calibration);
        record(seed, before, after, result.calibration);
        EXPECT_GT(before.agreement.rms, 2e-3);
        // the resolution of the encoders alone causes 0.02 mm; the required values are 0.1 and 0.3
        // mm
        EXPECT_LT(after.agreement.rms, 0.03e-3);
        EXPECT_LT(after.agreement.worst, 0.1e-3);
        EXPECT_LT(after.truth.rms, 0.03e-3);
        // the error stated by the calibration agrees with the true one
        EXPECT_NEAR(result.calibration.agreement_rms / after.agreement.rms, 1, 0.15);
        EXPECT_NEAR(result.calibration.link_length, 0.05, 0.02e-3);
        EXPECT_NEAR(result.calibration.slips, 0.05, 0.02);
        for (size_t i = 0; i < 2; ++i) {
            // the offset of the turret is part of the pose (README.md)
            const Vec3 off = *result.calibration.devices[i].joint_offset - rig.offsets[i];
            EXPECT_EQ(result.calibration.devices[i].joint_offset->x(), 0);
            EXPECT_LT(off.tail<2>().norm(), 0.02 * kDegree);
        }
    }
}

TEST(Calibration, WithoutAJigBringsThemTogetherStill) {
    const Faulty rig;
    CalibrationInput input = rig.input();
    move_link(rig, 0.05, input);
    const Calibration calibration = calibrate(input).calibration;
    const Judged after = judge(rig, &calibration);
    EXPECT_LT(after.agreement.rms, 0.05e-3);
    EXPECT_LT(after.agreement.worst, 0.2e-3);
    // quantities that only a jig can determine stay as in the rig file, for both devices together
    EXPECT_GT(after.truth.rms, 0.2e-3);
    EXPECT_LT(after.truth.rms, 10e-3);
    EXPECT_FALSE(calibration.jig_rms);
}

TEST(Calibration, WithoutJointAnglesSaysWhatRemains) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        Faulty rig(seed);
        rig.joints = false;
        CalibrationInput input = rig.input();
        move_link(rig, 0.05, input);
        touch_jig(rig, input);
        const Calibration calibration = calibrate(input).calibration;
        const Judged after = judge(rig, &calibration);
        record(seed, judge(rig, nullptr), after, calibration);
        // ten times worse than with joint angles. The stated error is not smaller than the true
        // error; it is larger if both devices have the same error at one position, but not at the
        // two ends of the link
        EXPECT_GT(after.agreement.rms, 0.2e-3);
        EXPECT_GT(calibration.agreement_rms, 0.9 * after.agreement.rms);
        EXPECT_LT(calibration.agreement_rms, 2.2 * after.agreement.rms);
        EXPECT_GT(calibration.link_worst, 0.5 * after.agreement.worst);
        EXPECT_LT(calibration.link_worst, 2 * after.agreement.worst);
        EXPECT_FALSE(calibration.devices[0].joint_offset);
    }
}

TEST(Calibration, FindsThreeDevicesJoinedToTheFirst) {
    Faulty rig;
    rig.X_WD.push_back({rotation_xyz(Vec3(90, 0, 0) * kDegree), {0, 0, 0.07}});
    rig.true_D.push_back({rotation_xyz(Vec3(0.01, -0.03, 0.02)), {2e-3, 1e-3, -1e-3}});
    rig.offsets.push_back(Vec3(0, 1, -1) * kDegree);
    CalibrationInput input = rig.input();
    input.devices.push_back({"middle", "", rig.X_WD[2], kLinks});
    move_link(rig, 0.02, input);
    CalibrationInput other;
    move_link(rig, 0.02, other);
    for (CalibrationInput::LinkSample sample : other.link_samples) {
        // moves the other end of the link to the third device
        const Vec3 p =
            rig.X_WD[1] *
            (rig.true_D[1] * model::phantom_position(kLinks, sample.at_b.joints + rig.offsets[1]));
        sample.b = 2;
        sample.at_b = rig.report(2, p);
        input.link_samples.push_back(sample);
    }
    touch_jig(rig, input);
    const Calibration calibration = calibrate(input).calibration;
    ASSERT_EQ(calibration.devices.size(), 3U);
    const Vec3 off = *calibration.devices[2].joint_offset - rig.offsets[2];
    EXPECT_LT(off.tail<2>().norm(), 0.05 * kDegree);
    const Vec3 p_W(0.01, 0.02, 0.08);
    const CalibrationReading at = rig.report(2, p_W);
    EXPECT_LT(
        (rig.X_WD[2] * calibration.devices[2].correction(kLinks).position(at.p_DH, at.joints) - p_W)
            .norm(),
        0.1e-3);
}

std::string refusal(const CalibrationInput& input) {
    try {
        calibrate(input);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Calibration, RefusesWhatTellsTooLittleAndSaysWhatToDo) {
    const Faulty rig;
    const auto said = [&](const CalibrationInput& input, const std::string& words) {
        const std::string text = refusal(input);
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    CalibrationInput input = rig.input();
    move_link(rig, 0, input, {1, 1, 1}, 20);
    said(input, "20 samples are too few; 300 are needed. Move the endpoints, joined, through all");

    input = rig.input();
    move_link(rig, 0, input, {1, 1, 0.1});
    said(input, "mm deep, but 60 are needed. Move the endpoints");

    input = rig.input();
    move_link(rig, 0, input, {0.1, 0.1, 0.1});
    said(input, "mm deep, but 60 are needed");

    input = rig.input();
    Random random(5, "one way");
    while (input.link_samples.size() < 1000) {
        const Vec3 p = some_place(random);
        const Vec3 d(0.025, 0, 0);
        if (rig.reach(p + d) && rig.reach(p - d))
            input.link_samples.push_back({0, 1, rig.report(0, p + d), rig.report(1, p - d)});
    }
    said(input, "the link pointed nearly the same way");

    input = rig.input();
    move_link(rig, 0, input);
    touch_jig(rig, input);
    for (CalibrationInput::JigSample& sample : input.jig_samples) sample.point = sample.point & 1;
    said(input, "on a line, or too near to each other. Touch three or more");

    input = rig.input();
    move_link(rig, 0, input);
    for (CalibrationInput::LinkSample& sample : input.link_samples)
        sample.at_a = rig.report(0, some_place(random));
    said(input, "the endpoints were not held by one link");

    input = rig.input();
    input.devices.push_back({"middle", "", {}, {}});
    move_link(rig, 0, input);
    said(input, "the middle's device was joined to no other");
}

TEST(Calibration, IsTheSameAfterItsFile) {
    const Faulty rig;
    CalibrationInput input = rig.input();
    input.devices[1].serial = "P-17";
    move_link(rig, 0, input, {1, 1, 1}, 400);
    Calibration calibration = calibrate(input).calibration;
    calibration.date = "2026-11-21";
    Calibration read;
    Diagnostics diagnostics;
    read_fields(read, parse_yaml(to_yaml(write_fields(calibration)), "calibration.yaml"),
                diagnostics);
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(to_yaml(write_fields(read)), to_yaml(write_fields(calibration)));
    EXPECT_EQ(read.find("index")->serial, "P-17");
    const CalibrationReading at = rig.report(0, {0.01, 0.02, 0.06});
    EXPECT_EQ(read.devices[0].correction(kLinks).position(at.p_DH, at.joints),
              calibration.devices[0].correction(kLinks).position(at.p_DH, at.joints));
}

TEST(Calibration, CountsDays) {
    EXPECT_EQ(days_between("2026-11-21", "2026-12-22T10:00:00+01:00"), 31);
    EXPECT_EQ(days_between("2026-11-21", "2026-11-20"), -1);
    EXPECT_FALSE(days_between("2026-13-21", "2026-11-20"));
    EXPECT_FALSE(days_between("yesterday", "2026-11-20"));
}

/// The arm is far from the position that its driver assumes.
TEST(Correction, SlopeIsThatOfItsPositions) {
    Random random(8, "slope");
    for (const bool joints : {true, false}) {
        Correction correction;
        correction.X = {rotation_by({0.1, -0.05, 0.2}), {0.01, 0.02, -0.01}};
        correction.joint_offset = {0.02, -0.03, 0.05};
        correction.stretch << 0.02, 0.01, -0.01, 0.01, -0.03, 0.02, -0.01, 0.02, 0.01;
        if (joints) correction.arm = kLinks;
        for (int n = 0; n < 100; ++n) {
            const Vec3 q(random.uniform(-1, 1), random.uniform(-0.3, 0.8),
                         random.uniform(-0.3, 0.8));
            const Vec3 p = model::phantom_position(kLinks, q);
            constexpr double kStep = 1e-6;
            for (int i = 0; i < 3; ++i) {
                const auto at = [&](double step) {
                    const Vec3 moved = p + step * Vec3::Unit(i);
                    return correction.position(moved, model::phantom_joints(kLinks, moved));
                };
                const Vec3 slope = (at(kStep) - at(-kStep)) / (2 * kStep);
                EXPECT_LT((correction.slope(q).col(i) - slope).norm(), 1e-7);
            }
        }
    }
}

}  // namespace
}  // namespace dihaptic::rig::calibration_test
