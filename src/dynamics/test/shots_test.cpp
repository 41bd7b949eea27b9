// Fires a hundred shots of each kind (shots.h). `./dev soak` fires thousands.
#include "dynamics/test/shots.h"

namespace dihaptic::dynamics::shots_test {
namespace {

constexpr uint64_t kShots = 100;

TEST(Shots, DoNotPassThroughThinPlates) {
    EXPECT_LT(shots(Shot::At::plate, 0, kShots).deep, 3);
}
TEST(Shots, DoNotPassThroughACup) {
    EXPECT_LT(shots(Shot::At::cup, 0, kShots).deep, 3);
}
TEST(Shots, DoNotPassThroughWhatFliesTowardsThem) {
    EXPECT_LT(shots(Shot::At::each_other, 0, kShots).deep, 5);
}

}  // namespace
}  // namespace dihaptic::dynamics::shots_test
