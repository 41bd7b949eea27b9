// Steps two thousand extreme scenes, changing the solver twenty times a second, and checks that no
// step takes so long that a device would switch its force off. Each scene runs twice, with
// identical results, and the shorter of the two times of each step is used, to exclude time taken
// by other programs.
#include <gtest/gtest.h>

#include <time.h>

#include <cstdio>

#include "dynamics/test/extreme.h"

namespace dihaptic::dynamics::bounded_soak {
namespace {

constexpr int kScenes = 2000;
constexpr int kSteps = 100;
constexpr int kChange = 50;          // number of steps between changes of the solver
constexpr double kMaxPause = 40e-3;  // [s], the setting safety: max_pause

/// Processor time used by this thread [s].
double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Step {
    double time = 0;  // [s]
    contact::SolveStats stats;
    bool touched = false;
};

std::vector<Step> steps_of(uint64_t seed) {
    Extreme extreme(seed);
    std::vector<Step> out;
    for (int i = 0; i < kSteps; ++i) {
        if (i % kChange == 0)
            extreme.world().set_solver(contact::Solver((i / kChange + seed) % contact::kSolvers));
        const double begin = now();
        const StepStatus status = extreme.step(i);
        out.push_back({now() - begin, extreme.world().solve_stats(), extreme.touched()});
        if (status == StepStatus::diverged) extreme.world().mend();
    }
    return out;
}

TEST(BoundedSoak, NoStepOfTwoThousandExtremeScenesTakesTooLong) {
    double longest = 0;
    double per_visit = 0;  // time per visit in steps with much work
    int64_t most_work = 0;
    int touched = 0;
    int out_of_work = 0;
    int over_ten = 0;
    for (uint64_t seed = 0; seed < kScenes; ++seed) {
        const std::vector<Step> first = steps_of(seed);
        const std::vector<Step> again = steps_of(seed);
        for (size_t i = 0; i < first.size(); ++i) {
            const contact::SolveStats& stats = first[i].stats;
            ASSERT_EQ(stats.work, again[i].stats.work) << seed << " " << i;
            ASSERT_EQ(stats.residual, again[i].stats.residual) << seed << " " << i;
            const double time = std::min(first[i].time, again[i].time);
            EXPECT_LT(time, kMaxPause) << seed << " " << i;
            longest = std::max(longest, time);
            over_ten += time > 10e-3 ? 1 : 0;
            most_work = std::max(most_work, stats.work);
            if (stats.work > World::kMostSolveWork / 2)
                per_visit = std::max(per_visit, time / static_cast<double>(stats.work));
            touched += first[i].touched ? 1 : 0;
            out_of_work += stats.route == contact::Route::out_of_work ? 1 : 0;
        }
    }
    std::printf(
        "%d steps, %d with a touch, %d out of work; longest %.1f ms, %d above 10 ms; most "
        "work %ld visits, at most %.0f ns each\n",
        kScenes * kSteps, touched, out_of_work, 1e3 * longest, over_ten,
        static_cast<long>(most_work), 1e9 * per_visit);
}

}  // namespace
}  // namespace dihaptic::dynamics::bounded_soak
