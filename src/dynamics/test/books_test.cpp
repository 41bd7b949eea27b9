// Tests the books of a step: they balance in scenes of every kind, they agree with closed forms
// where these exist, and every fault planted in a step is reported.
#include "dynamics/books.h"

#include <gtest/gtest.h>

#include <functional>

#include "dynamics/test/blocks.h"
#include "dynamics/world_impl.h"

namespace dihaptic::dynamics {

/// Plants a fault between applying the loads of a step and solving it.
class Sabotage {
  public:
    using Problem = contact::ContactProblem;
    using Fault = std::function<void(Problem& problem, btRigidBody& first)>;

    static void plant(World& world, Fault fault) {
        World::Impl& inside = *world.impl_;
        world.watch_problems([&inside, fault = std::move(fault)](const Problem& problem, auto) {
            // the watcher gets the state from which the step continues
            fault(const_cast<Problem&>(problem), *btRigidBody::upcast(inside.island_bodies[0]));
        });
    }
};

namespace books_test {
namespace {

constexpr int kSteps = 1000;

struct Example {
    std::string name;
    std::string yaml;
    std::function<void(World&, int)> act = [](World&, int) {};
};

World made_of(const Example& example, contact::Solver solver = contact::Solver::newton) {
    scene::Scene scene;
    Diagnostics diagnostics;
    read_fields(scene, parse_yaml(example.yaml, "test"), diagnostics);
    scene::complete(scene, "scenes", diagnostics);
    diagnostics.throw_if_errors();
    frame::DynamicsSettings settings = awake();
    settings.solver = solver;
    World world(scene, settings);
    world.activate();
    return world;
}

const std::string kTable =
    "  - {name: table, shape: box, size_mm: [2000, 2000, 100], position_mm: [0, 0, -50], fixed: "
    "yes, friction: 0.6}\n";

/// Returns a function that throws a body in the first step.
std::function<void(World&, int)> thrown(int body, const Vec3& v, const Vec3& w = Vec3::Zero()) {
    return [=](World& world, int step) {
        if (step == 0) world.set_motion({body}, v, w);
    };
}

std::vector<Example> things_on_the_table() {
    const std::string bodies = "bodies:\n" + kTable;
    return {
        {"a block at rest",
         bodies + "  - {name: a, shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 20], "
                  "mass_g: 100}\n"},
        {"a block that slides to rest",
         bodies + "  - {name: a, shape: box, size_mm: [40, 60, 20], position_mm: [0, 0, 10], "
                  "mass_g: 100}\n",
         thrown(1, {0.8, 0.3, 0}, {0, 0, 4})},
        {"a brick that tumbles",
         bodies + "  - {name: a, shape: box, size_mm: [100, 60, 20], position_mm: [0, 0, 120], "
                  "mass_g: 200}\n",
         thrown(1, {0.3, 0, 0.5}, {5, 11, -7})},
        {"a stack",
         bodies +
             "  - {name: a, shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 20], mass_g: "
             "100}\n"
             "  - {name: b, shape: box, size_mm: [40, 40, 40], position_mm: [5, 0, 60], mass_g: "
             "50}\n"
             "  - {name: c, shape: box, size_mm: [40, 40, 40], position_mm: [0, 5, 100], mass_g: "
             "20}\n",
         [](World& world, int step) {
             if (step < 300) world.apply({2}, {0.3, 0, 0}, {0, 0, 1e-3});
         }},
        {"a ball that rolls",
         bodies + "  - {name: a, shape: sphere, radius_mm: 20, position_mm: [0, 0, 20], mass_g: "
                  "100}\n",
         thrown(1, {0.5, 0, 0}, {0, 25, 3})},
        {"a can that rolls",
         bodies + "  - {name: a, shape: cylinder, radius_mm: 30, length_mm: 90, position_mm: [0, "
                  "0, 30], rotation_deg: [90, 0, 0], mass_g: 300}\n",
         thrown(1, {0.3, 0, 0}, {0, 10, 0})},
        {"balls that bounce",
         bodies + "  - {name: a, shape: sphere, radius_mm: 20, position_mm: [0, 0, 120], mass_g: "
                  "100, surface: {restitution: 0.9}}\n"
                  "  - {name: b, shape: sphere, radius_mm: 15, position_mm: [5, 2, 200], mass_g: "
                  "50, surface: {restitution: 0.9}}\n"},
        {"a soft block",
         bodies + "  - {name: a, shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 40], "
                  "mass_g: 100, surface: {stiffness_N_m: 2000, damping_Ns_m: 1}}\n",
         thrown(1, {0.2, 0, 0})},
    };
}

std::vector<Example> mechanisms() {
    return {
        {"a double pendulum",
         "bodies:\n"
         "  - {name: a, shape: box, size_mm: [200, 20, 20], position_mm: [100, 0, 500], mass_g: "
         "100}\n"
         "  - {name: b, shape: box, size_mm: [200, 20, 20], position_mm: [300, 0, 500], mass_g: "
         "100}\n"
         "joints:\n"
         "  - {name: j1, kind: hinge, between: [a], position_mm: [0, 0, 500], axis: [0, 1, 0]}\n"
         "  - {name: j2, kind: hinge, between: [a, b], position_mm: [200, 0, 500], axis: [0, 1, "
         "0]}\n"},
        {"a top",
         "bodies:\n"
         "  - {name: a, shape: cylinder, radius_mm: 40, length_mm: 20, position_mm: [60, 0, 500], "
         "rotation_deg: [0, 90, 0], mass_g: 200}\n"
         "joints:\n"
         "  - {name: j3, kind: ball, between: [a], position_mm: [0, 0, 500]}\n",
         thrown(0, Vec3::Zero(), {100, 0, 0})},
        {"a slider on a spring, pulled by a motor",
         "bodies:\n"
         "  - {name: a, shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 500], mass_g: 100}\n"
         "joints:\n"
         "  - {name: j4, kind: slider, between: [a], position_mm: [0, 0, 500], axis: [0, 0, 1], "
         "stiffness_N_m: "
         "50, friction_N: 0.1}\n",
         [](World& world, int step) {
             if (step >= 300 && step < 600)
                 world.drive_joint(0, {0.05 * std::sin(0.01 * step), 20});
         }},
        {"a bushing",
         "bodies:\n"
         "  - {name: a, shape: box, size_mm: [60, 30, 20], position_mm: [0, 0, 500], mass_g: 100}\n"
         "joints:\n"
         "  - {name: j5, kind: bushing, between: [a], position_mm: [10, 0, 500], stiffnesses_N_m: "
         "[100, 200, "
         "300], turn_stiffnesses_Nm_rad: [0.05, 0.05, 0.05]}\n",
         thrown(0, {0.1, 0.05, 0}, {1, 2, 0})},
    };
}

std::vector<Example> examples() {
    std::vector<Example> out = things_on_the_table();
    for (Example& one : mechanisms()) out.push_back(std::move(one));
    return out;
}

TEST(Books, BalanceWithEverySolver) {
    for (const Example& example : examples()) {
        for (size_t i = 0; i < enum_names(contact::Solver{}).size(); ++i) {
            SCOPED_TRACE(example.name + ", " +
                         std::string(enum_name(static_cast<contact::Solver>(i))));
            World world = made_of(example, static_cast<contact::Solver>(i));
            int unbalanced = 0;
            double most = 0;
            double turning = 0;
            for (int step = 0; step < 2 * kSteps; ++step) {
                example.act(world, step);
                world.step(kStep);
                unbalanced += world.balance().unbalanced;
                most = std::max(most, world.balance().momentum_imbalance);
                turning = std::max(turning, world.balance().angular_imbalance);
            }
            EXPECT_EQ(unbalanced, 0);
            EXPECT_LT(most, 1e-12);
            EXPECT_LT(turning, 1e-12);
        }
    }
}

TEST(Books, AddUpFromStepToStep) {
    for (const Example& example : examples()) {
        SCOPED_TRACE(example.name);
        World world = made_of(example);
        double sum = 0;
        double first = 0;
        for (int step = 0; step < kSteps; ++step) {
            example.act(world, step);
            world.step(kStep);
            const Balance& balance = world.balance();
            if (step == 0) first = balance.energy();
            if (step > 0) sum += balance.work - balance.dissipated + balance.energy_imbalance;
        }
        EXPECT_NEAR(world.balance().energy() - first, sum, 1e-11);
    }
}

TEST(Books, OfAFreeFallExchangePotentialForKineticEnergy) {
    World world = make({block({0, 0, 1})});
    world.step(kStep);
    const double before = world.balance().energy();
    for (int step = 1; step < 300; ++step) world.step(kStep);
    EXPECT_NEAR(world.balance().kinetic, 0.1 * std::pow(0.3 * kGravity, 2) / 2, 1e-12);
    EXPECT_NEAR(world.balance().energy(), before, 1e-14);
}

TEST(Books, OfAPushAreItsWork) {
    // a force lifts a block by half a metre: its work equals the gain in both energies
    World world = make({block({0, 0, 1})}, awake());
    world.step(kStep);
    double work = 0;
    const double before = world.balance().energy();
    const double from = world.states()[0].X_WB.p.z() - kStep / 2 * world.states()[0].v_WB.z();
    for (int step = 0; step < 500; ++step) {
        world.apply({0}, {0, 0, 2}, Vec3::Zero());
        world.step(kStep);
        work += world.balance().work;
    }
    const double to = world.states()[0].X_WB.p.z() - kStep / 2 * world.states()[0].v_WB.z();
    EXPECT_NEAR(work, 2 * (to - from), 1e-12);
    EXPECT_NEAR(world.balance().energy() - before, work, 1e-12);
}

TEST(Books, OfASlideAreWhatFrictionTakes) {
    World world = make({table(0.5), block({0, 0, 0.02}, 0.5)}, awake());
    world.set_motion({1}, {1, 0, 0}, Vec3::Zero());
    double taken = 0;
    for (int step = 0; step < 1000; ++step) {
        world.step(kStep);
        taken += world.balance().dissipated;
    }
    EXPECT_NEAR(taken, 0.05, 1e-6);
    EXPECT_NEAR(world.balance().kinetic, 0, 1e-12);
}

TEST(Books, OfAnImpactAreWhatRestitutionLeaves) {
    scene::Body ball = block({0, 0, 0.1});
    ball.shape = scene::Shape::sphere(0.02);
    ball.surface.restitution = 0.5;
    World world = make({table(), ball}, awake());
    double taken = 0;
    double before = 0;
    for (int step = 0; step < 200 && taken == 0; ++step) {
        before = world.balance().kinetic;
        world.step(kStep);
        taken = world.balance().dissipated;
    }
    EXPECT_NEAR(taken / before, 0.75, 0.02);
}

/// A fault must be reported if it moves a body by this much in half a second [m].
constexpr double kMoved = 5e-3;
constexpr int kFaultySteps = kSteps / 2;

/// Largest deviation of the bodies' positions due to a fault [m].
double off(const World& world, const World& well) {
    double most = 0;
    for (size_t i = 0; i < world.states().size(); ++i)
        most = std::max(most, (world.states()[i].X_WB.p - well.states()[i].X_WB.p).norm());
    return most;
}

struct Planted {
    std::string name;
    Sabotage::Fault fault;
};

void add(btRigidBody& body, contact::ProblemBody& in, const Vec3& v, const Vec3& w) {
    body.setLinearVelocity(body.getLinearVelocity() + to_bullet(v));
    body.setAngularVelocity(body.getAngularVelocity() + to_bullet(w));
    in.v_W += v;
    in.w_W += w;
}

std::vector<Planted> faults() {
    using Problem = Sabotage::Problem;
    const auto moves = [](double share) {
        return [share](Problem& p, btRigidBody& body) {
            add(body, p.bodies[0], share * p.bodies[0].v_W, Vec3::Zero());
        };
    };
    const auto turns = [](double share) {
        return [share](Problem& p, btRigidBody& body) {
            add(body, p.bodies[0], Vec3::Zero(), share * p.bodies[0].w_W);
        };
    };
    const auto falls = [](double share) {
        return [share](Problem& p, btRigidBody& body) {
            add(body, p.bodies[0], Vec3(0, 0, -share * kGravity * kStep), Vec3::Zero());
        };
    };
    return {
        {"its speed grows", moves(1e-3)},
        {"its speed fades", moves(-1e-2)},
        {"its spin grows", turns(1e-3)},
        {"its spin fades", turns(-1e-2)},
        {"its weight acts twice", falls(1)},
        {"its weight is left out", falls(-1)},
        {"its mass is another",
         [](Problem& p, auto&) { p.bodies[0].inverse_mass.topLeftCorner<3, 3>() *= 1.2; }},
        {"its inertia is another",
         [](Problem& p, auto&) { p.bodies[0].inverse_mass.bottomRightCorner<3, 3>() *= 1.2; }},
        {"only one of two bodies feels what is between them",
         [](Problem& p, auto&) {
             const auto free_a = [](auto& one) {
                 if (one.b != contact::kFixed) one.a = contact::kFixed;
             };
             for (auto& contact : p.contacts) free_a(contact);
             for (auto& joint : p.joints) free_a(joint);
         }},
        {"contacts are lost",
         [](Problem& p, auto&) {
             for (auto& contact : p.contacts) contact.a = contact.b = contact::kFixed;
         }},
        {"contacts push",
         [](Problem& p, auto&) {
             for (auto& contact : p.contacts) contact.bias = std::min(contact.bias, 0.0) - 2;
         }},
        {"forces act beside where they are",
         [](Problem& p, auto&) {
             for (auto& contact : p.contacts) {
                 contact.p_AC_W.x() += 2e-3;
                 contact.p_BC_W.x() += 2e-3;
             }
         }},
        {"it is moved on",
         [](Problem&, btRigidBody& body) {
             body.getWorldTransform().getOrigin().setX(body.getWorldTransform().getOrigin().x() +
                                                       1e-5);
         }},
        {"it is turned on",
         [](Problem&, btRigidBody& body) {
             body.getWorldTransform().setRotation(btQuaternion(btVector3(0, 0, 1), 1e-3) *
                                                  body.getWorldTransform().getRotation());
         }},
    };
}

TEST(Books, TellEveryFaultThatMovesAnything) {
    const std::vector<Example> all = examples();
    ASSERT_EQ(all.size(), 12u);
    std::vector<World> well;
    for (const Example& example : all) {
        well.push_back(made_of(example));
        for (int step = 0; step < kFaultySteps; ++step) {
            example.act(well.back(), step);
            well.back().step(kStep);
        }
    }
    int told_faults = 0;
    for (const Planted& planted : faults()) {
        int told = 0;
        for (size_t i = 0; i < all.size(); ++i) {
            const Example& example = all[i];
            SCOPED_TRACE(planted.name + ": " + example.name);
            World world = made_of(example);
            Sabotage::plant(world, planted.fault);
            bool unbalanced = false;
            for (int step = 0; step < kFaultySteps; ++step) {
                example.act(world, step);
                world.step(kStep);
                unbalanced = unbalanced || world.balance().unbalanced;
            }
            told += unbalanced;
            const double moved = off(world, well[i]);
            EXPECT_TRUE(unbalanced || moved < kMoved) << moved << " m off";
        }
        EXPECT_GT(told, 0) << planted.name;
        told_faults += told > 0;
        std::cout << planted.name << ": told in " << told << " of 12 scenes\n";
    }
    EXPECT_GE(told_faults, 12);
}

TEST(Books, TellContactsThatAreNotRecorded) {
    frame::DynamicsSettings settings = awake();
    settings.max_contacts = 2;
    World world = make({table(), block({0, 0, 0.02})}, settings);
    for (int step = 0; step < 10; ++step) world.step(kStep);
    EXPECT_TRUE(world.balance().unbalanced);
    EXPECT_NEAR(world.balance().momentum_imbalance, 0.1 * kGravity * kStep / 2, 2e-5);
}

TEST(Books, TellABodyThatTurnsTooFastForTheStep) {
    World world = make({block({0, 0, 1})}, awake());
    world.set_motion({0}, Vec3::Zero(), {0, 0, 1000});
    world.step(kStep);
    EXPECT_TRUE(world.balance().unbalanced);
    EXPECT_GT(world.balance().angular_imbalance, 1e-3);
}

TEST(Books, TellWhatBeginsWithinSomethingElse) {
    World world = make({table(), block({0, 0, 0.005})}, awake());
    bool told = false;
    for (int step = 0; step < 100; ++step) {
        world.step(kStep);
        told = told || world.balance().unbalanced;
    }
    EXPECT_TRUE(told);
}

}  // namespace
}  // namespace books_test
}  // namespace dihaptic::dynamics
