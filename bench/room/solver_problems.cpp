#include "bench/solver_problems.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "bench/friction.h"
#include "bench/shaking.h"
#include "measure/blocks.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

using model::kGravity;
constexpr double kFriction = 0.6;
constexpr std::array kGrowth{8, 20, 52, 100, 164, 200};  // numbers of contacts of walls and piles

/// Keeps problems with nearly the wanted number of contacts.
class Recorder {
  public:
    explicit Recorder(std::vector<RecordedProblem>& out) : out_(out) {}

    dynamics::World::ProblemWatcher watcher(int contacts) {
        return [this, contacts](const contact::ContactProblem& problem,
                                std::span<const contact::Impulse> start) {
            const double ratio = static_cast<double>(problem.contacts.size()) / contacts;
            if (!on || std::abs(ratio - 1) > kContactsWithin) return;
            out_.push_back({problem, {start.begin(), start.end()}});
        };
    }
    bool on = false;

  private:
    std::vector<RecordedProblem>& out_;
};

/// Keeps at most `most` problems, spread evenly from first to last.
void thin_out(std::vector<RecordedProblem>& problems, size_t most) {
    if (problems.size() <= most) return;
    for (size_t i = 0; i < most; ++i) problems[i] = problems[i * problems.size() / most];
    problems.resize(most);
}

/// The shaking of a world during the recording of its problems.
struct Course {
    double settle = 0;  ///< settling time before the recording, with Bullet's solver [s]
    double time = 1;    ///< time recorded [s]
    double force = 1;   ///< force on each body at the end of that time, relative to its weight
};

/// Shakes every movable body with growing force.
std::vector<RecordedProblem> shake(const scene::Scene& scene, int contacts, const Course& course) {
    frame::DynamicsSettings settings;
    settings.solver = contact::Solver::sequential_impulse;
    settings.sleeping = false;
    dynamics::World world(scene, settings);
    std::vector<RecordedProblem> out;
    Recorder recorder(out);
    world.watch_problems(recorder.watcher(contacts));
    world.activate();
    for (double time = 0; time < course.settle; time += kStep) world.step(kStep);

    world.set_solver(contact::Solver::newton);
    Random random(1, "shaking");
    std::vector<std::pair<dynamics::BodyIndex, Shaking>> shakings;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].moves_at_all()) continue;
        const double weight = scene::mass(scene.bodies[i]) * kGravity;
        const double arm = scene::extent(scene.bodies[i].shape) / 4;
        shakings.push_back(
            {{static_cast<int>(i)}, {random, course.force * weight, course.force * weight * arm}});
    }
    for (int i = 0; i < 20; ++i) world.step(kStep);  // comes to rest with Newton's method as well
    recorder.on = true;
    for (double time = 0; time < course.time; time += kStep) {
        const double share = time / course.time;
        for (const auto& [body, shaking] : shakings)
            world.apply(body, share * shaking.force(time), share * shaking.torque(time));
        world.step(kStep);
    }
    return out;
}

/// The block of `bench grasp` between the pads, shaken from phase `first` to the end of the hold.
std::vector<RecordedProblem> shake_grasp(const scene::Scene& scene, const hand::HandSpec& hand,
                                         measure::BenchSetup setup, int contacts,
                                         measure::GraspPhase first, double force) {
    setup.settings.dynamics.solver = contact::Solver::newton;
    setup.settings.dynamics.sleeping = false;
    measure::Bench bench(scene, hand, setup);
    dynamics::World& world = bench.servo().world();
    std::vector<RecordedProblem> out;
    Recorder recorder(out);
    world.watch_problems(recorder.watcher(contacts));

    Random random(1, "shaking");
    std::vector<std::pair<dynamics::BodyIndex, Shaking>> shakings;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].moves_at_all()) continue;
        // the grip force far exceeds the block's weight
        const double size = i == 1 ? force : 0.8 * scene::mass(scene.bodies[i]) * kGravity;
        shakings.push_back({{static_cast<int>(i)}, {random, size, size * measure::kBlockSize / 4}});
    }
    const auto& phases = bench.driver().phases();
    const double begin = phases[static_cast<size_t>(first)].start;
    const double end = phases[std::min<size_t>(measure::kHold, phases.size() - 1)].end;
    bench.run(
        [](const frame::Frame&) {},
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands& commands) {
            const double time = static_cast<double>(last.sequence + 1) * kStep;
            recorder.on = time >= begin && time < end;
            if (!recorder.on) return;
            const double share = (time - begin) / (end - begin);
            for (const auto& [body, shaking] : shakings)
                frame::add(commands.task.loads,
                           {body.value, share * shaking.force(time), share * shaking.torque(time)});
        });
    return out;
}

}  // namespace

scene::Scene brick_wall_scene(int bricks, int courses) {
    const Vec3 size(0.06, 0.04, 0.02);
    const double pitch = size.x() + 0.002;  // joints are open: bricks touch only above and below
    const double shift =
        0.4 * pitch;  // less than half, since end bricks would otherwise stand on an edge
    scene::Scene scene;
    scene.bodies = {measure::table(2, kFriction)};
    for (int course = 0; course < courses; ++course) {
        for (int i = 0; i < bricks; ++i) {
            const double x = i * pitch + (course % 2) * shift;
            scene::Body brick = measure::box(fmt::format("brick {}.{}", course, i), size,
                                             {x, 0, (course + 0.5) * size.z()}, kFriction);
            brick.density = 1000;
            scene.bodies.push_back(brick);
        }
    }
    return scene;
}

scene::Scene pile_scene(int boxes) {
    Random random(1, "pile");
    scene::Scene scene;
    for (int side = 0; side < 4; ++side) {
        const double slope = 40 * std::numbers::pi / 180;  // steeper than the friction angle
        const double turn = side * std::numbers::pi / 2;
        scene::Body body = measure::table(2, kFriction);
        body.name = fmt::format("side {}", side);
        body.rotation = {0, slope, turn};
        body.position = rotation_xyz(body.rotation) * Vec3(-1, 0, -0.05);
        scene.bodies.push_back(body);
    }
    const int columns = std::max(1, static_cast<int>(std::cbrt(boxes)));
    const double pitch = 0.07;  // above the longest diagonal
    for (int i = 0; i < boxes; ++i) {
        const auto length = [&] { return random.uniform(0.02, 0.04); };
        const Vec3 size(length(), length(), length());
        const double middle = (columns - 1) / 2.0;
        const Vec3 cell(i % columns - middle, i / columns % columns - middle,
                        i / (columns * columns) + 0.7 * columns);
        const Vec3 loose(random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005), 0.04);
        scene::Body body =
            measure::box(fmt::format("box {}", i), size, pitch * cell + loose, kFriction);
        body.density = 600;
        body.rotation =
            Vec3(random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3));
        scene.bodies.push_back(body);
    }
    return scene;
}

std::vector<ProblemGroup> record_problems(size_t most, const measure::Progress& progress) {
    std::vector<ProblemGroup> out;
    const double steps = 4 + 2 * kGrowth.size();
    const auto add = [&](const std::string& family, int contacts, const auto& record) {
        if (progress) {
            progress(fmt::format("recording {}, {} contacts", family, contacts),
                     static_cast<double>(out.size()) / steps);
        }
        std::vector<RecordedProblem> problems = record();
        thin_out(problems, most);
        out.push_back({family, contacts, std::move(problems)});
    };

    add("block", 4, [] { return shake(stack_scene(1), 4, {0, 2, 1.5}); });
    measure::BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    add("grasp", 8, [&] {
        setup.hold_time = 1;
        return shake_grasp(measure::grasp_scene(setup), measure::grasp_hand(setup), setup, 8,
                           measure::kRise, 6);
    });
    add("grasp", 16, [&] {
        scene::Scene scene = measure::grasp_scene(setup);
        scene::Body upper = scene.bodies[1];
        upper.name = "upper";
        upper.position.z() += measure::kBlockSize;
        scene.bodies.push_back(upper);
        hand::HandSpec hand = measure::grasp_hand(setup);
        hand.script.resize(2);  // the block stays on the table
        hand.script[1].duration = 3;
        return shake_grasp(scene, hand, setup, 16, measure::kWait, 6);
    });
    add("stack", 40, [] { return shake(stack_scene(10), 40, {0, 1.5, 1}); });
    constexpr std::array<std::pair<int, int>, kGrowth.size()> kWalls{
        {{1, 2}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 5}}};
    for (size_t i = 0; i < kGrowth.size(); ++i) {
        add("wall", kGrowth[i], [&] {
            return shake(brick_wall_scene(kWalls[i].first, kWalls[i].second), kGrowth[i],
                         {0, 1, 1});
        });
    }
    // numbers of boxes; the number of contacts depends on their fall
    constexpr std::array<int, kGrowth.size()> kPiles{2, 4, 13, 22, 36, 46};
    for (size_t i = 0; i < kGrowth.size(); ++i) {
        add("pile", kGrowth[i], [&] {
            return shake(pile_scene(kPiles[i]), kGrowth[i], {1.5, 0.15, 0.6});
        });
    }
    return out;
}

}  // namespace dihaptic::bench
