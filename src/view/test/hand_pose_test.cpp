#include "view/hand_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "view/hand_mesh.h"

namespace dihaptic::view::hand_pose_test {

Vec3 random_place(std::mt19937& random, double half) {
    std::uniform_real_distribution<double> draw(-half, half);
    return {draw(random), draw(random), draw(random)};
}

std::vector<double> lengths(const HandPose& hand) {
    std::vector<double> out;
    for (const HandPose::Finger& finger : hand.fingers) {
        for (size_t k = 0; k < 3; ++k)
            out.push_back((finger.joints[k + 1] - finger.joints[k]).norm());
        // the palm is rigid
        out.push_back((finger.joints[0] - hand.palm.p).norm());
    }
    return out;
}

TEST(HandPose, EndsWhereThumbAndIndexTouch) {
    std::mt19937 random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 thumb = random_place(random, 0.1);
        const Vec3 index = thumb + random_place(random, 0.065);
        if ((index - thumb).norm() < 0.005) continue;
        const auto hand = hand_pose(thumb, index);
        ASSERT_TRUE(hand);
        // each fingertip's middle is outside its point, by the thickness of the finger pad
        const Vec3 a = (index - thumb).normalized();
        EXPECT_LT((hand->fingers[0].joints[3] - (thumb - kPad * a)).norm(), 1e-6);
        EXPECT_LT((hand->fingers[1].joints[3] - (index + kPad * a)).norm(), 1e-6);
    }
}

TEST(HandPose, KeepsTheLengthsOfBones) {
    const std::vector<double> open = lengths(open_hand());
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 thumb = random_place(random, 0.1);
        const auto hand = hand_pose(thumb, thumb + random_place(random, 0.2));
        ASSERT_TRUE(hand);
        const std::vector<double> now = lengths(*hand);
        for (size_t k = 0; k < now.size(); ++k) EXPECT_NEAR(now[k], open[k], 1e-9) << k;
    }
}

TEST(HandPose, ComesFromThePersonAndFromAbove) {
    const auto hand = hand_pose({-0.025, 0, 0.03}, {0.025, 0, 0.03});
    ASSERT_TRUE(hand);
    const Vec3 wrist = hand->palm * Vec3(0.03, 0.1, 0);
    EXPECT_LT(wrist.y(), -0.12);
    EXPECT_GT(wrist.z(), 0.09);
}

TEST(HandPose, IsNoneWithoutAGrip) {
    EXPECT_FALSE(hand_pose({0, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(hand_pose({0, 0, 0}, Vec3::Constant(std::nan(""))));
}

/// Volume enclosed by a surface, by the divergence theorem, and the number of edges that do not
/// belong to exactly two triangles that run along them in opposite directions.
std::pair<double, size_t> volume_and_open_edges(const Triangles& skin) {
    double six = 0;
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t i = 0; i < skin.indices.size(); i += 3) {
        const auto at = [&](size_t k) {
            return skin.vertices[skin.indices[i + k]].p.cast<double>();
        };
        six += at(0).dot(at(1).cross(at(2)));
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = skin.indices[i + k], b = skin.indices[i + (k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    const auto open =
        std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; });
    return {six / 6, static_cast<size_t>(open)};
}

TEST(HandMesh, IsAClosedSkinOfAHandsVolumeThatTouchesWhereTheFingersTouch) {
    const HandMesh mesh;
    EXPECT_NEAR(static_cast<double>(mesh.posed(open_hand()).indices.size()) / 3, 15000, 1000);
    for (const double opening : {0.01, 0.03, 0.06, 0.09}) {
        SCOPED_TRACE(opening);
        const Vec3 thumb(-opening / 2, 0, 0.05), index(opening / 2, 0, 0.05);
        const Triangles skin = mesh.posed(*hand_pose(thumb, index));
        const auto [volume, open] = volume_and_open_edges(skin);
        EXPECT_EQ(open, 0u);
        // men's hands have 350 to 450 ml, and some of the wrist is drawn too
        EXPECT_GT(volume, 300e-6);
        EXPECT_LT(volume, 550e-6);
        for (const Vec3& touched : {thumb, index}) {
            double nearest = 1;
            for (const Vertex& vertex : skin.vertices)
                nearest = std::min(nearest, (vertex.p.cast<double>() - touched).norm());
            EXPECT_LT(nearest, 0.003);
        }
        for (const Vertex& vertex : skin.vertices) EXPECT_NEAR(vertex.n.norm(), 1, 1e-5);
    }
}

}  // namespace dihaptic::view::hand_pose_test
