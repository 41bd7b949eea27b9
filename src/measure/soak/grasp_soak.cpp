// A million consecutive solves of grasps that differ in all that an experiment may vary: how often
// a solver hands over, and whether anything ever misses.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "measure/test/bars.h"

namespace dihaptic::measure {
namespace {

class Soak : public ::testing::TestWithParam<dynamics::Solver> {};
INSTANTIATE_TEST_SUITE_P(Grasps, Soak,
                         ::testing::Values(dynamics::Solver::stewart_trinkle,
                                           dynamics::Solver::staggered_projections,
                                           dynamics::Solver::newton),
                         solver_name);

TEST_P(Soak, AMillionSolvesOfGrasps) {
    constexpr int kSolves = 1'000'000;
    constexpr size_t kContacts = 12;
    Random random(1, "grasp soak");
    int64_t solves = 0;
    int64_t fallbacks = 0;  // of newton; of the others, those with up to 12 contacts
    int64_t missed = 0;
    int64_t not_finite = 0;
    int runs = 0;
    while (solves < kSolves) {
        BenchSetup setup;
        setup.settings.dynamics.solver = GetParam();
        setup.settings.dynamics.sleeping = false;
        setup.settings.coupling.stiffness = std::pow(10, random.uniform(2.3, 3.7));
        setup.mass = std::pow(10, random.uniform(-2, 0));
        setup.friction = random.uniform(0.1, 1.5);
        setup.fingering = static_cast<Fingering>(runs % 4);
        setup.hold_time = 1.5;
        scene::Scene scene = grasp_scene(setup);
        hand::HandSpec hand = grasp_hand(setup);
        scene.bodies[1].rotation.z() = random.uniform(-0.3, 0.3);
        scene.bodies[1].position.x() = random.uniform(-0.005, 0.005);
        for (hand::FingerPlace& finger : hand.fingers)
            finger.offset += Vec3(0, random.uniform(-0.01, 0.01), random.uniform(-0.012, 0.012));
        Bench bench(scene, hand, setup);
        Random push(static_cast<uint64_t>(runs), "pushes");
        size_t contacts = 0;
        bench.servo().world().watch_problems(
            [&](const contact::ContactProblem& problem, std::span<const contact::Impulse>) {
                contacts += problem.contacts.size();
            });
        const servo::Director shake = [&](const servo::Frame&, std::span<const haptics::Handle>,
                                          servo::Commands& commands) {
            contacts = 0;
            const double size = setup.mass * 5;
            servo::add(commands.task.loads,
                       {1, size * Vec3(push.normal(), push.normal(), push.normal()),
                        0.005 * size * Vec3(push.normal(), push.normal(), push.normal())});
        };
        bench.run(
            [&](const servo::Frame& frame) {
                if (frame.contacts.empty()) return;
                ++solves;
                if (GetParam() == dynamics::Solver::newton || contacts <= kContacts)
                    fallbacks += frame.solver_fallback;
                missed += (frame.status & servo::kSolverMissed) != 0;
                not_finite +=
                    !frame.bodies[1].X_WB.p.allFinite() || !std::isfinite(frame.solver_residual);
            },
            shake);
        ++runs;
    }
    std::printf("%lld solves in %d grasps: %lld fallbacks, %lld missed\n",
                static_cast<long long>(solves), runs, static_cast<long long>(fallbacks),
                static_cast<long long>(missed));
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(not_finite, 0);
    const int64_t most =
        GetParam() == dynamics::Solver::newton ? kSolves / 100'000 : kSolves / 1000;
    EXPECT_LE(fallbacks, most);
}

}  // namespace
}  // namespace dihaptic::measure
