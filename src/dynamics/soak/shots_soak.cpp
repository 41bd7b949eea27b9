// Fires thousands of shots (test/shots.h) and checks that none passes through its target.
#include <cstdio>

#include "dynamics/test/shots.h"

namespace dihaptic::dynamics::shots_soak {
namespace {

constexpr uint64_t kShots = 3000;

void shoot(const char* where, Shot::At at) {
    const Shots out = shots(at, 1'000'000, kShots);
    std::printf("%d shots %s: %d passed, %d deeper than 0.5 mm, the deepest %.2f mm\n",
                static_cast<int>(kShots), where, out.passed, out.deep, 1e3 * out.deepest);
}

TEST(ShotsSoak, NothingPassesThroughThinPlates) {
    shoot("at thin plates", Shot::At::plate);
}
TEST(ShotsSoak, NothingPassesThroughACup) {
    shoot("into a cup", Shot::At::cup);
}
TEST(ShotsSoak, NothingPassesThroughWhatFliesTowardsIt) {
    shoot("at each other", Shot::At::each_other);
}

}  // namespace
}  // namespace dihaptic::dynamics::shots_soak
