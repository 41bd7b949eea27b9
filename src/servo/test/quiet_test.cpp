// Tests that a tick does nothing but compute: it must take no lock, throw no exception and make no
// system call, with each solver, each kind of proxy and each coupling.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <mutex>

#include "planted.h"
#include "testing/quiet_guard.h"

namespace dihaptic::servo::quiet_test {
namespace {

using testing::QuietGuard;
using testing::system_calls;
using testing::SystemCalls;

struct Case {
    contact::Solver solver = contact::Solver::newton;
    scene::ProxyKind proxy = scene::ProxyKind::rigid;
    frame::CouplingKind coupling = frame::CouplingKind::implicit;
};

class Quiet : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Ticks, Quiet,
                         ::testing::Values(Case{}, Case{contact::Solver::staggered_projections},
                                           Case{contact::Solver::stewart_trinkle},
                                           Case{contact::Solver::sequential_impulse},
                                           Case{contact::Solver::newton, scene::ProxyKind::point},
                                           Case{contact::Solver::newton, scene::ProxyKind::rigid,
                                                frame::CouplingKind::dual_spring}),
                         [](const auto& of) {
                             return std::string(enum_name(of.param.solver)) + "_" +
                                    std::string(enum_name(of.param.proxy)) + "_" +
                                    std::string(enum_name(of.param.coupling));
                         });

frame::Settings settings_of(const Case& c) {
    frame::Settings out;
    out.dynamics.solver = c.solver;
    out.proxy.kind = c.proxy;
    out.coupling.kind = c.coupling;
    return out;
}

/// Runs the ticks of a whole grasp: fingers in the air, touching, lifting, holding.
void grasp(PlantedGrasp& fingers, const frame::Director& director = {}) {
    for (int i = 0; i < 900; ++i) fingers.tick(director);
}

TEST_P(Quiet, TakesNoLockAndThrowsNothing) {
    DIHAPTIC_NEEDS_QUIET_GUARD();
    PlantedGrasp fingers(settings_of(GetParam()));
    const QuietGuard guard;
    grasp(fingers);
    EXPECT_EQ(guard.locks(), 0u);
    EXPECT_EQ(guard.throws(), 0u);
}

TEST_P(Quiet, MakesNoSystemCall) {
    DIHAPTIC_NEEDS_QUIET_GUARD();
    PlantedGrasp fingers(settings_of(GetParam()));
    const SystemCalls calls = system_calls([&] { grasp(fingers); });
    EXPECT_EQ(calls.ended, "");
    for (const auto& [number, count] : calls.count)
        ADD_FAILURE() << "system call " << number << ", " << count << " times";
}

TEST(QuietGuard, SeesALockAnExceptionAndACall) {
    DIHAPTIC_NEEDS_QUIET_GUARD();
    PlantedGrasp fingers;
    std::mutex mutex;
    const QuietGuard guard;
    grasp(fingers, [&](const frame::Frame&, std::span<const frame::Handle>, frame::Commands&) {
        const std::lock_guard lock(mutex);
        try {
            throw 1;
        } catch (int) {
        }
    });
    EXPECT_EQ(guard.locks(), 900u);
    EXPECT_EQ(guard.throws(), 900u);

    const SystemCalls calls = system_calls([&] {
        grasp(fingers, [&](const frame::Frame&, std::span<const frame::Handle>, frame::Commands&) {
            syscall(SYS_getppid);
        });
    });
    EXPECT_EQ(calls.ended, "");
    ASSERT_EQ(calls.count.size(), 1u);
    EXPECT_EQ(calls.count.at(SYS_getppid), 900);
}

}  // namespace
}  // namespace dihaptic::servo::quiet_test
