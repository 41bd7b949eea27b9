// Tests displays and their registration: mistakes in rig files, and how accurately a screen is
// located by touching it.
#include "display/display.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/field_writer.h"
#include "base/random.h"
#include "base/unit.h"
#include "rig/registration_run.h"
#include "testing/files.h"

namespace dihaptic::rig::display_test {
namespace {

const std::string kRig =
    "origin_mm: [0, 20, -30]\ndevices:\n  - {finger: thumb, backend: simulated}\ndisplays:\n"
    "  - name: mirror\n    lower_left_mm: [-250, -130, -70]\n"
    "    lower_right_mm: [250, -130, -70]\n    upper_left_mm: [-250, 130, 80]\n"
    "    eyes: { position_mm: [0, -330, 420] }\n";

Rig read(const testing::TemporaryFolder& folder, const std::string& yaml,
         Diagnostics& diagnostics) {
    return read_rig(folder.write("rig.yaml", yaml), diagnostics);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
}

TEST(Displays, MoveWithTheWorldsOrigin) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Rig rig = read(folder, kRig, diagnostics);
    diagnostics.throw_if_errors();
    const display::Display* const display = &display_of(rig, "");
    EXPECT_LT((display->lower_left - Vec3(-0.25, -0.15, -0.04)).norm(), 1e-15);
    EXPECT_LT((display->eyes.position - Vec3(0, -0.35, 0.45)).norm(), 1e-15);
    EXPECT_LT((display->eyes.right() - display->eyes.left() - Vec3(0.063, 0, 0)).norm(), 1e-15);
    EXPECT_EQ(&display_of(rig, "mirror"), display);
    EXPECT_THROW(display_of(rig, "wall"), Error);
}

TEST(Displays, HaveEyesThatFollowTheHeadIfThereIsOne) {
    const auto with = [](const std::string& eyes, const std::string& head) {
        const testing::TemporaryFolder folder;
        Diagnostics diagnostics;
        const Rig rig = read(folder, replaced(kRig, "420]", "420]" + eyes) + head, diagnostics);
        std::string said;
        for (const Problem& problem : diagnostics.problems()) said += problem.text() + "\n";
        if (rig.head) {
            EXPECT_LT((rig.head->position - Vec3(0, -0.02, 0.03)).norm(), 1e-15);
        }
        return said;
    };
    EXPECT_EQ(with(", tracked: yes", "head: { stream: Head }\n"), "");
    EXPECT_NE(with(", tracked: yes", "").find("tracked: needs a tracked head"), std::string::npos);
    EXPECT_NE(with("", "head: { stream: Head }\n").find("warning: head: moves no eyes"),
              std::string::npos);
    EXPECT_NE(with(", tracked: yes", "head: { stream: Head, along: [0, 0, 0] }\n")
                  .find("along: has no direction"),
              std::string::npos);
    EXPECT_NE(with(", tracked: yes", "head: { unit: mm }\n").find("stream: is missing"),
              std::string::npos);
}

TEST(Displays, ThatNobodyCanSeeAreErrors) {
    for (const auto& [what, by, said] : {
             std::tuple{"[250, -130, -70]", "[-250, -130, -70]", "lower_right: is 0 mm from"},
             {"[-250, 130, 80]", "[-250, 1e5, 80]", "upper_left: is 1e+05 mm from"},
             {"[-250, 130, 80]", "[-150, 130, 80]", "makes an angle of 71.6 degrees"},
             {"[0, -330, 420]", "[0, 330, -420]", "is behind the screen"},
             {"[0, -330, 420]", "[0, 0, 10]", "mm in front of the screen's plane"},
             {"position_mm: [0, -330, 420]", "position_mm: [0, -330, 420], along: [0, 0, 0]",
              "along: has no direction"},
             {"mirror", "mir/ror", "cannot be a name"},
             {"    eyes", "    registration: none.yaml\n    eyes", "none.yaml cannot be used"},
             {"    eyes", "    mirrored: yes\n    eyes", "mirrored"},
         }) {
        const testing::TemporaryFolder folder;
        Diagnostics diagnostics;
        read(folder, replaced(kRig, what, by), diagnostics);
        ASSERT_TRUE(diagnostics.has_errors()) << by;
        std::string all;
        for (const Problem& problem : diagnostics.problems()) all += problem.text() + "\n";
        EXPECT_NE(all.find(said), std::string::npos) << all;
        EXPECT_NE(all.find("rig.yaml:"), std::string::npos) << all;
    }
}

display::Display example() {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    return read(folder, kRig, diagnostics).displays.at(0);
}

/// The display rotated by 2 degrees about a random axis through its middle, and moved by 5 mm.
display::Display misplaced(const display::Display& display, Random& random) {
    const auto unit = [&] {
        return Vec3(random.normal(), random.normal(), random.normal()).normalized();
    };
    const Vec3 middle = display.at({0.5, 0.5});
    const Quat R(Eigen::AngleAxisd(2 * kDegree, unit()));
    const Vec3 by = 5e-3 * unit();
    display::Display out = display;
    for (Vec3* corner : {&out.lower_left, &out.lower_right, &out.upper_left})
        *corner = middle + R * (*corner - middle) + by;
    return out;
}

TEST(Registration, FindsAScreenThatIsExactlySomewhereElse) {
    Random random(3, "registration");
    const display::Display display = example();
    const display::Display seen = misplaced(display, random);
    std::vector<Vec3> touches;
    for (const display::Cross& cross : display::crosses()) touches.push_back(seen.at(cross));
    const display::RegistrationResult found = display::register_screen(display, touches);
    EXPECT_LT((found.registration.upper_left - seen.upper_left).norm(), 1e-12);
    EXPECT_NEAR(found.moved, 5e-3, 1e-12);
    EXPECT_NEAR(found.turned, 2 * kDegree, 1e-9);
    EXPECT_LT(found.registration.worst, 1e-12);
}

TEST(Registration, FindsAMisplacedScreenByANoisyFinger) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Rig rig = read(folder, kRig, diagnostics);
    const Guide quiet{[](const Guidance&) {}, [] { return false; }};
    constexpr int kScreens = 20;
    double off = 0, turned = 0;
    int within = 0;
    for (uint64_t seed = 1; seed <= kScreens; ++seed) {
        Random random(seed, "screens");
        const display::Display display = display_of(rig, "");
        const display::Display seen = misplaced(display, random);
        const std::vector<Vec3> touches =
            lead_registration(rig, "thumb", seen, quiet, {0.3e-3, seed});
        const display::RegistrationResult found = display::register_screen(display, touches);
        display::Display is = display;
        is.set(found.registration);
        const double away = (is.at({0.5, 0.5}) - seen.at({0.5, 0.5})).norm();
        const double tilted = is.right()
                                  .cross(is.up())
                                  .normalized()
                                  .cross(seen.right().cross(seen.up()).normalized())
                                  .norm();
        if (away < 0.2e-3 && tilted < 0.1 * kDegree) ++within;
        off += away * away / kScreens;
        turned += tilted * tilted / kScreens;
        // noise of 0.3 mm along three axes, less the degrees of freedom of the fit
        EXPECT_NEAR(found.registration.rms, 0.5e-3, 0.15e-3) << seed;
    }
    RecordProperty("off_mm", number_text(1e3 * std::sqrt(off)));
    RecordProperty("turned_deg", number_text(std::sqrt(turned) / kDegree));
    // 0.3 mm divided by the square root of 20 touches, times the square root of three axes
    EXPECT_NEAR(std::sqrt(off), 0.116e-3, 0.04e-3);
    EXPECT_LT(std::sqrt(turned), 0.06 * kDegree);
    EXPECT_GE(within, 18);
}

TEST(Registration, IsKeptInTheRigFilesFrame) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const std::string yaml = replaced(kRig, "    eyes", "    registration: found.yaml\n    eyes");
    const std::string file = folder.write("rig.yaml", yaml);
    const Rig rig = read_rig_to_register(file, diagnostics);
    diagnostics.throw_if_errors();
    Random random(5, "registration");
    const display::Display seen = misplaced(display_of(rig, ""), random);
    std::vector<Vec3> touches;
    for (const display::Cross& cross : display::crosses()) touches.push_back(seen.at(cross));
    display::RegistrationResult found = display::register_screen(display_of(rig, ""), touches);
    found.registration.date = "2026-11-24";
    store_registration(rig, found.registration, registration_file(display_of(rig, ""), file));
    const Rig again = read_rig(file, diagnostics);
    diagnostics.throw_if_errors();
    EXPECT_LT((display_of(again, "").lower_right - seen.lower_right).norm(), 1e-9);
    found.registration.date = "yesterday";
    store_registration(rig, found.registration, registration_file(display_of(rig, ""), file));
    Diagnostics wrong;
    read_rig(file, wrong);
    ASSERT_EQ(wrong.problems().size(), 1u);
    EXPECT_NE(
        wrong.problems()[0].text().find("found.yaml:1: error: date: 'yesterday' is not a date"),
        std::string::npos)
        << wrong.problems()[0].text();
    check_age(again, "2026-12-01", diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    check_age(again, "2027-02-01", diagnostics);
    ASSERT_EQ(diagnostics.problems().size(), 1u);
    EXPECT_NE(diagnostics.problems()[0].text().find("mirror was registered 69 days ago"),
              std::string::npos);
}

std::string refusal(const std::vector<Vec3>& touches) {
    try {
        display::register_screen(example(), touches);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Registration, RefusesTouchesThatContradictEachOther) {
    const display::Display display = example();
    std::vector<Vec3> touches;
    for (const display::Cross& cross : display::crosses()) touches.push_back(display.at(cross));
    EXPECT_EQ(refusal(touches), "");
    std::vector<Vec3> large = touches;
    for (Vec3& p : large) p *= 1.05;
    EXPECT_NE(refusal(large).find("1.05 times as large"), std::string::npos) << refusal(large);
    std::vector<Vec3> slipped = touches;
    slipped[6] += Vec3(0, 0, 0.02);
    EXPECT_NE(refusal(slipped).find("most at cross 7"), std::string::npos) << refusal(slipped);
}

TEST(Registration, CrossesAreTurnedRoundForAMirror) {
    display::Display display = example();
    const std::string plain = display::cross_picture(display);
    display.mirrored = display::Mirrored::left_right;
    const std::string turned = display::cross_picture(display);
    EXPECT_EQ(plain.find("scale(-1 1)"), std::string::npos);
    EXPECT_NE(turned.find("translate(1600.0 0) scale(-1 1)"), std::string::npos);
    EXPECT_NE(plain.find(">20</text>"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::rig::display_test
