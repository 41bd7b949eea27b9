#include "view/hand_bones.h"

#include <gtest/gtest.h>

#include <random>

namespace dihaptic::view::hand_bones_test {

constexpr size_t kThumbTip = 4, kIndexTip = 8;  // indices of the bones that end at the fingertips

Vec3 random_place(std::mt19937& random, double half) {
    std::uniform_real_distribution<double> draw(-half, half);
    return {draw(random), draw(random), draw(random)};
}

std::vector<double> lengths(const std::vector<Bone>& bones) {
    std::vector<double> out;
    for (const Bone& bone : bones) out.push_back((bone.to - bone.from).norm());
    return out;
}

TEST(HandBones, EndWhereThumbAndIndexTouch) {
    std::mt19937 random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 thumb = random_place(random, 0.1);
        const Vec3 index = thumb + random_place(random, 0.065);
        if ((index - thumb).norm() < 0.005) continue;
        const std::vector<Bone> bones = hand_bones(thumb, index);
        ASSERT_EQ(bones.size(), 21u);
        // each bone ends outside its point, by the thickness of the finger pad
        const Vec3 a = (index - thumb).normalized();
        EXPECT_LT((bones[kThumbTip].to - (thumb - 0.006 * a)).norm(), 1e-6);
        EXPECT_LT((bones[kIndexTip].to - (index + 0.006 * a)).norm(), 1e-6);
    }
}

TEST(HandBones, OfAFingerAreJoinedAndKeepTheirLengths) {
    const std::vector<double> first = lengths(hand_bones({-0.02, 0, 0.05}, {0.02, 0, 0.05}));
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 thumb = random_place(random, 0.1);
        const std::vector<Bone> bones = hand_bones(thumb, thumb + random_place(random, 0.2));
        const std::vector<double> now = lengths(bones);
        for (size_t k = 0; k < bones.size(); ++k) EXPECT_NEAR(now[k], first[k], 1e-9) << k;
        for (const size_t tip : {kThumbTip, kIndexTip, size_t{12}, size_t{16}, size_t{20}}) {
            EXPECT_EQ(bones[tip].from, bones[tip - 1].to);
            EXPECT_EQ(bones[tip - 1].from, bones[tip - 2].to);
        }
    }
}

TEST(HandBones, ComeFromThePersonAndFromAbove) {
    const std::vector<Bone> bones = hand_bones({-0.025, 0, 0.03}, {0.025, 0, 0.03});
    EXPECT_LT(bones[0].to.y(), -0.12);  // the end of the forearm
    EXPECT_GT(bones[0].to.z(), 0.09);
}

TEST(HandBones, AreNoneWithoutAGrip) {
    EXPECT_TRUE(hand_bones({0, 0, 0}, {0, 0, 0}).empty());
    EXPECT_TRUE(hand_bones({0, 0, 0}, Vec3::Constant(std::nan(""))).empty());
}

}  // namespace dihaptic::view::hand_bones_test
