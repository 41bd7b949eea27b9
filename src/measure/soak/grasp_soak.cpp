// Solves a million grasps, which vary in every parameter that an experiment may vary. Counts how
// often a solver falls back to a different one, and checks whether a solve ever misses its
// tolerance.
//
// The first, quick starting points of the newton solver (kNewtonStarts) were chosen using the first
// family, so that family shows the quality of the fit, while the other families test the choice.
// Their seeds and ranges were fixed before their first run. Five misses in the third family showed
// that the later starts must be cautious (docs/adr/0034-caution.md); other problems showed how
// cautious they must be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/random.h"
#include "measure/test/bars.h"

namespace dihaptic::measure {
namespace {

enum class Family {
    chosen_on,    ///< the grasps for which newton's starts were chosen
    other_seed,   ///< different random draws from the same ranges
    other_grips,  ///< squeezed by 2 to 30 mm, pushed in gusts, and held by fingers farther off
                  ///< centre
};
constexpr auto enum_names(Family) {
    return std::array{"chosen_on", "other_seed", "other_grips"};
}

struct Case {
    contact::Solver solver;
    Family family;
};

/// Writes a problem, with the impulses from which its solve started, in the form in which
/// src/contact/test/jammed_test.cpp reads it. Returns the name of the file.
std::string write_missed(const contact::ContactProblem& problem,
                         std::span<const contact::Impulse> start, int64_t number) {
    const auto file =
        std::filesystem::temp_directory_path() / fmt::format("missed-grasp-{}.txt", number);
    std::ofstream out(file);
    out.precision(17);
    const auto write = [&](const auto& matrix) {
        for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
            for (Eigen::Index j = 0; j < matrix.cols(); ++j) out << matrix(i, j) << ' ';
        }
        out << '\n';
    };
    out << problem.bodies.size() << ' ' << problem.contacts.size() << '\n';
    for (const contact::ProblemBody& body : problem.bodies) {
        write(body.inverse_mass);
        write(body.v_W);
        write(body.w_W);
    }
    for (size_t j = 0; j < problem.contacts.size(); ++j) {
        const contact::ProblemContact& contact = problem.contacts[j];
        out << contact.a << ' ' << contact.b << '\n';
        write(contact.p_AC_W);
        write(contact.p_BC_W);
        write(contact.R_WC);
        out << contact.bias << ' ';
        write(contact.slip);
        out << contact.friction << ' ' << contact.torsion_radius << ' ' << contact.compliance
            << '\n';
        write(start[j]);
    }
    return file;
}

class Soak : public ::testing::TestWithParam<Case> {
  protected:
    bool is_other() const { return GetParam().family == Family::other_grips; }
    /// The random stream from which scenes are drawn. The pushes in run i are drawn from a stream
    /// with the seed pushes() + i.
    Random scenes() const {
        return GetParam().family == Family::chosen_on ? Random(1, "grasp soak")
                                                      : Random(2012, enum_name(GetParam().family));
    }
    uint64_t pushes() const { return GetParam().family == Family::chosen_on ? 0 : 1'000'000; }
};

std::vector<Case> cases() {
    std::vector<Case> out;
    for (const auto solver : {contact::Solver::stewart_trinkle,
                              contact::Solver::staggered_projections, contact::Solver::newton}) {
        for (const Family family : {Family::chosen_on, Family::other_seed, Family::other_grips})
            out.push_back({solver, family});
    }
    return out;
}
INSTANTIATE_TEST_SUITE_P(Grasps, Soak, ::testing::ValuesIn(cases()), [](const auto& of) {
    return std::string(enum_name(of.param.solver)) + "_" + std::string(enum_name(of.param.family));
});

TEST_P(Soak, AMillionSolvesOfGrasps) {
    constexpr int kSolves = 1'000'000;
    constexpr size_t kContacts = 12;
    const contact::Solver solver = GetParam().solver;
    Random random = scenes();
    int64_t solves = 0;
    int64_t fallbacks = 0;  // for solvers other than newton, only with up to 12 contacts
    int64_t missed = 0;
    int64_t not_finite = 0;
    std::array<int64_t, enum_names(contact::Route{}).size()> routes{};
    int runs = 0;
    while (solves < kSolves) {
        BenchSetup setup;
        setup.settings.dynamics.solver = solver;
        setup.settings.dynamics.sleeping = false;
        setup.settings.coupling.stiffness = std::pow(10, random.uniform(2.3, 3.7));
        setup.mass = std::pow(10, random.uniform(-2, 0));
        setup.friction = random.uniform(0.1, 1.5);
        setup.fingering = static_cast<Fingering>(runs % 4);
        setup.hold_time = 1.5;
        if (is_other()) setup.squeeze = random.uniform(0.002, 0.03);
        const double off = is_other() ? 1.5 : 1;
        scene::Scene scene = grasp_scene(setup);
        hand::HandSpec hand = grasp_hand(setup);
        scene.bodies[1].rotation.z() = random.uniform(-0.3, 0.3);
        scene.bodies[1].position.x() = random.uniform(-0.005, 0.005);
        for (hand::FingerPlace& finger : hand.fingers)
            finger.offset +=
                off * Vec3(0, random.uniform(-0.01, 0.01), random.uniform(-0.012, 0.012));
        Bench bench(scene, hand, setup);
        Random push(pushes() + static_cast<uint64_t>(runs), "pushes");
        size_t contacts = 0;
        contact::ContactProblem last;  // the last problem, which is copied in case it is missed
        std::vector<contact::Impulse> start;
        bench.servo().world().watch_problems(
            [&](const contact::ContactProblem& problem, std::span<const contact::Impulse> from) {
                contacts += problem.contacts.size();
                last = problem;
                start.assign(from.begin(), from.end());
            });
        const frame::Director shake = [&](const frame::Frame& frame, std::span<const frame::Handle>,
                                          frame::Commands& commands) {
            contacts = 0;
            // gusts last 50 ms in every 200 ms, and are five times as strong
            const bool gust = is_other() && frame.sequence % 200 < 50;
            const double size = setup.mass * (gust ? 25 : 5);
            frame::add(commands.task.loads,
                       {1, size * Vec3(push.normal(), push.normal(), push.normal()),
                        0.005 * size * Vec3(push.normal(), push.normal(), push.normal())});
        };
        bench.run(
            [&](const frame::Frame& frame) {
                if (frame.contacts.empty()) return;
                ++solves;
                ++routes[static_cast<size_t>(frame.solver_route)];
                if (solver == contact::Solver::newton || contacts <= kContacts)
                    fallbacks += frame.solver_fallback;
                const bool misses = (frame.status & kSolverMissed) != 0;
                missed += misses;
                if (misses && solver == contact::Solver::newton)
                    std::printf("missed: %s\n", write_missed(last, start, missed).c_str());
                not_finite +=
                    !frame.bodies[1].X_WB.p.allFinite() || !std::isfinite(frame.solver_residual);
            },
            shake);
        ++runs;
    }
    std::printf("%lld solves in %d grasps: %lld fallbacks, %lld missed\n",
                static_cast<long long>(solves), runs, static_cast<long long>(fallbacks),
                static_cast<long long>(missed));
    for (size_t i = 0; i < routes.size(); ++i) {
        if (routes[i] > 0)
            std::printf("  %s: %lld\n", enum_names(contact::Route{})[i],
                        static_cast<long long>(routes[i]));
    }
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(not_finite, 0);
    const int64_t most = solver == contact::Solver::newton ? kSolves / 100'000 : kSolves / 1000;
    EXPECT_LE(fallbacks, most);
}

}  // namespace
}  // namespace dihaptic::measure
