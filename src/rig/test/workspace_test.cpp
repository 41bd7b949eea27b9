#include "rig/workspace.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "base/random.h"

namespace dihaptic::rig::workspace_test {
namespace {

/// A rig of devices whose reaches are boxes.
Rig boxes(const std::vector<Vec3>& places, const std::string& edges) {
    Rig rig;
    for (const Vec3& place : places) {
        Device& device = rig.devices.emplace_back();
        device.finger = number_text(rig.devices.size());
        device.backend = "simulated";
        device.position = place;
        device.options = parse_yaml("workspace_mm: " + edges, "rig.yaml");
    }
    return rig;
}

/// A rig of `count` Premiums with arms, arranged around one point.
Rig premiums(int count) {
    Rig rig;
    for (int i = 0; i < count; ++i) {
        Device& device = rig.devices.emplace_back();
        device.finger = number_text(i);
        device.backend = "simulated";
        device.position = {0, 0, 0.07};
        const double around[] = {90, -90, 0};
        device.rotation = Vec3(90, 0, around[i]) * std::numbers::pi / 180;
        device.options = parse_yaml("preset: premium_1_0\narm: phantom\n", "rig.yaml");
    }
    return rig;
}

TEST(Workspace, OfTwoBoxesIsTheirOverlap) {
    const auto found =
        find_workspace(reaches(boxes({{0, 0, 0}, {0.05, 0.02, 0.01}}, "[200, 160, 120]")));
    EXPECT_NEAR(found.volumes[0], 0.2 * 0.16 * 0.12, 0.02 * 0.2 * 0.16 * 0.12);
    EXPECT_NEAR(found.shared, 0.15 * 0.14 * 0.11, 0.02 * 0.15 * 0.14 * 0.11);
    const Eigen::AlignedBox3d truth(Vec3(-0.05, -0.06, -0.05), Vec3(0.1, 0.08, 0.06));
    EXPECT_TRUE(truth.contains(found.box));
    EXPECT_LT((truth.sizes() - found.box.sizes()).maxCoeff(), 0.008);
    EXPECT_LE(found.sphere_radius, 0.055);
    EXPECT_GT(found.sphere_radius, 0.051);
    EXPECT_NEAR(found.sphere_centre.z(), 0.005, 0.002);
}

TEST(Workspace, OfDevicesApartIsEmpty) {
    const auto found = find_workspace(reaches(boxes({{0, 0, 0}, {0.5, 0, 0}}, "[200, 160, 120]")));
    EXPECT_EQ(found.shared, 0);
    EXPECT_TRUE(found.box.isEmpty());
    EXPECT_EQ(found.sphere_radius, 0);
}

TEST(Workspace, ProposesAWorldOverItsFloorAndAWallThatItHolds) {
    const auto all = reaches(boxes({{0, 0, 0}, {0.05, 0.02, 0.01}}, "[200, 160, 120]"));
    const auto found = find_workspace(all);
    const Placement proposed = propose_placement(found);
    EXPECT_LT((proposed.origin - Vec3(0.025, 0.01, -0.04)).norm(), 0.005);
    EXPECT_EQ(out_of_reach(proposed.wall.box(), all), 0);
    Wall wide = proposed.wall;
    wide.size.x() *= 2;
    EXPECT_NEAR(out_of_reach(wide.box(), all), 0.5, 0.05);
}

TEST(Workspace, ThatIsThinHasNoBox) {
    const auto found =
        find_workspace(reaches(boxes({{0, 0, 0}, {0.1999, 0, 0}}, "[200, 200, 200]")));
    EXPECT_TRUE(found.box.isEmpty());
}

class Premiums : public ::testing::TestWithParam<int> {};

TEST_P(Premiums, ShareWhatAMonteCarloEstimateSays) {
    const Rig rig = premiums(GetParam());
    const auto all = reaches(rig);
    const auto found = find_workspace(all);
    // an estimate that does not use the code under test: joint angles are drawn in such a way that
    // points are uniformly distributed in the first device's reach (by |det J|), and each point is
    // then tested for the other devices
    Random random(7, "monte carlo");
    const model::PhantomLinks links;
    const model::PhantomLimits& limits = model::phantom_limits();
    const double most = links.thigh * links.shin * (links.thigh + links.shin);
    int64_t drawn = 0, in = 0;
    for (; drawn < 1500000; ++drawn) {
        Vec3 q;
        for (int i = 0; i < 3; ++i) q[i] = random.uniform(limits.low[i], limits.high[i]);
        const double density = model::phantom_determinant(links, q);
        if (!model::phantom_allows(q) || random.uniform(0, most) > density) continue;
        const Vec3 p_WH = rig.devices[0].X_WD() * model::phantom_position(links, q);
        bool by_all = true;
        for (size_t i = 1; i < all.size(); ++i) {
            const Vec3 p_DH = rig.devices[i].X_WD().inverse() * p_WH;
            const Vec3 back = model::phantom_joints(links, p_DH);
            by_all = by_all && model::phantom_allows(back) &&
                     (model::phantom_position(links, back) - p_DH).norm() < 1e-9;
        }
        if (by_all) ++in;
    }
    const double joints = (limits.high - limits.low).prod();
    const double estimate = joints * most * static_cast<double>(in) / static_cast<double>(drawn);
    EXPECT_NEAR(found.shared / estimate, 1, 0.02) << estimate * 1e3 << " litres";
    EXPECT_GT(estimate, 1e-4);

    // all points in the largest box and in the largest sphere are within every reach
    for (int n = 0; n < 5000; ++n) {
        const Vec3 d = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        Vec3 inside;
        for (int i = 0; i < 3; ++i)
            inside[i] = random.uniform(found.box.min()[i], found.box.max()[i]);
        for (const Reach& reach : all) {
            ASSERT_TRUE(reach.contains(found.sphere_centre + found.sphere_radius * d));
            ASSERT_TRUE(reach.contains(inside));
        }
    }
    RecordProperty("litres", number_text(found.shared * 1e3));
}
INSTANTIATE_TEST_SUITE_P(Workspace, Premiums, ::testing::Values(2, 3));

TEST(Workspace, SearchCanBeGivenUp) {
    int calls = 0;
    const auto twice = [&](double) {
        if (++calls == 3) throw std::runtime_error("given up");
    };
    EXPECT_THROW(find_workspace(reaches(boxes({{0, 0, 0}}, "[100, 100, 100]")), twice),
                 std::runtime_error);
    EXPECT_EQ(calls, 3);
}

TEST(Workspace, OfADeviceWithoutAnEndIsRefused) {
    try {
        reaches(simulated_rig({"thumb"}));
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("does not state its reach. Give workspace_mm"),
                  std::string::npos)
            << e.what();
    }
}

TEST(WorkspacePicture, NamesWhatItShows) {
    const auto all = reaches(boxes({{0, 0, 0}, {0.05, 0.02, 0.01}}, "[200, 160, 120]"));
    const std::string svg = workspace_picture(find_workspace(all), all, "two <boxes>");
    for (const char* words : {"two &lt;boxes&gt;", "shared: 2.3", "largest box", "100 mm"})
        EXPECT_NE(svg.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace dihaptic::rig::workspace_test
