#include "bench/scale.h"

#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include "bench/bench_log.h"
#include "bench/duration.h"
#include "bench/simulator.h"

namespace dihaptic::bench {
namespace {

/// The handles in each tick, which drive the bare world through the same grasp.
using HandleTrace = std::vector<std::vector<frame::Handle>>;

Cost measure_ticks(const measure::BenchSetup& setup, HandleTrace* trace) {
    const scene::Scene scene = measure::grasp_scene(setup);
    measure::Bench bench(scene, measure::grasp_hand(setup), setup);
    const BenchLog log(scene, setup.settings);
    recording::Recorder recorder = log.record(recording::Writing::in_place);
    servo::TickTimes times;
    times.reserve(static_cast<size_t>(bench.driver().duration() / setup.settings.tick()) + 2);
    bench.run(
        [&](const frame::Frame& frame) {
            recorder.record(frame);
            if (trace == nullptr) return;
            auto& handles = trace->emplace_back();
            for (const frame::FingerFrame& finger : frame.fingers)
                handles.push_back({finger.p_WH, finger.v_WH});
        },
        {}, &times);
    return {times.quantile(0.5), times.quantile(0.99), times.quantile(1)};
}

btVector3 vector(const Vec3& v) {
    return btVector3(v.x(), v.y(), v.z());
}

/// A plain Bullet world with the bodies, settings and fingers of a bench.
class BareWorld {
  public:
    BareWorld(const measure::BenchSetup& setup, const std::vector<frame::Handle>& start)
        : scene_(measure::grasp_scene(setup)),
          h_(setup.settings.step()),
          k_(setup.settings.coupling.stiffness),
          c_(haptics::damping(setup.settings.coupling, h_)) {
        world_.setGravity(vector(scene_.gravity));
        btContactSolverInfo& info = world_.getSolverInfo();
        const frame::DynamicsSettings& settings = setup.settings.dynamics;
        info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
        info.m_warmstartingFactor = 1;
        info.m_numIterations = settings.iterations;
        info.m_leastSquaresResidualThreshold = settings.tolerance * settings.tolerance;
        for (const scene::Body& body : scene_.bodies)
            add(body.shape.size, body.position, body.fixed ? 0 : scene::mass(body), body.friction);
        for (size_t i = 0; i < scene_.fingers.size(); ++i)
            add_proxy(scene_.fingers[i], start[i].p_WH);
    }
    ~BareWorld() {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    BareWorld(const BareWorld&) = delete;
    BareWorld& operator=(const BareWorld&) = delete;

    /// Couples the proxies to the handles.
    void drive(const std::vector<frame::Handle>& handles) {
        for (size_t i = 0; i < proxies_.size(); ++i) {
            btRigidBody& proxy = *proxies_[i];
            const btVector3 stretch =
                vector(handles[i].p_WH) - proxy.getWorldTransform().getOrigin();
            proxy.setLinearVelocity((proxy.getLinearVelocity() * scene_.fingers[i].mass +
                                     stretch * h_ * k_ + vector(handles[i].v_WH) * h_ * c_) *
                                    proxy.getInvMass());
        }
    }

    void step() { world_.stepSimulation(h_, 0, h_); }

  private:
    btRigidBody& add(const Vec3& size, const Vec3& position, double mass, double friction) {
        shapes_.push_back(std::make_unique<btBoxShape>(vector(size / 2)));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shapes_.back()->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo body(mass, nullptr, shapes_.back().get(), inertia);
        body.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), vector(position));
        body.m_friction = std::sqrt(friction);  // Bullet multiplies the two coefficients of a pair
        bodies_.push_back(std::make_unique<btRigidBody>(body));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }

    void add_proxy(const scene::Finger& finger, const Vec3& p_W) {
        btRigidBody& proxy = add(finger.shape.size, p_W, finger.mass, finger.friction);
        proxy.setGravity({0, 0, 0});
        proxy.setAngularFactor(0);
        proxy.setMassProps(finger.mass + h_ * c_ + h_ * h_ * k_, {0, 0, 0});
        proxies_.push_back(&proxy);
    }

    scene::Scene scene_;
    double h_;
    double k_;
    double c_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btBoxShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<btRigidBody*> proxies_;
};

/// Median step of a plain Bullet world with the same bodies, settings and finger movements.
double measure_bullet(const measure::BenchSetup& setup, const HandleTrace& trace) {
    BareWorld world(setup, trace.front());
    servo::TickTimes times;
    times.reserve(trace.size());
    for (const auto& handles : trace) {
        world.drive(handles);
        times.add(duration_of([&] { world.step(); }));
    }
    return times.quantile(0.5);
}

}  // namespace

std::vector<ScaleFigures> bench_scale(const measure::BenchSetup& base,
                                      const std::vector<int>& extras,
                                      const measure::Progress& progress) {
    std::vector<ScaleFigures> out;
    double done = 0;
    const auto say = [&](const std::string& what) {
        if (progress) progress(what, done++ / (3 * static_cast<double>(extras.size())));
    };
    for (const int extra : extras) {
        ScaleFigures figures;
        figures.extra = extra;
        measure::BenchSetup setup = base;
        setup.extra_blocks = extra;
        HandleTrace trace;
        say(fmt::format("{} extra blocks, awake", extra));
        setup.settings.dynamics.sleeping = false;
        figures.awake = measure_ticks(setup, &trace);
        say(fmt::format("{} extra blocks, bare Bullet", extra));
        figures.bullet_us = measure_bullet(setup, trace);
        say(fmt::format("{} extra blocks, asleep", extra));
        setup.settings.dynamics.sleeping = true;
        figures.asleep = measure_ticks(setup, nullptr);
        out.push_back(figures);
    }
    return out;
}

}  // namespace dihaptic::bench
