// A world in virtual time, which Python steps tick by tick.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <fmt/format.h>
#include <array>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "frame_values.h"
#include "haptics/safety.h"
#include "parts.h"
#include "plans.h"
#include "session/phase_director.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

/// Leads each finger as ordered by Python, and, before the first order, with the scene's own hand.
class LedHand : public hand::Driver {
  public:
    LedHand(std::shared_ptr<const hand::Driver> own, size_t fingers)
        : own_(std::move(own)), led_(fingers) {}

    void lead(size_t finger, const hand::FingerTarget& target) { led_[finger] = target; }
    void let_go(size_t finger) { led_[finger].reset(); }
    double duration() const override { return own_->duration(); }
    const std::vector<Phase>& phases() const override { return own_->phases(); }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        const auto& led = led_[static_cast<size_t>(finger)];
        return led ? *led : own_->target(finger, t);
    }
    std::shared_ptr<const hand::Driver> own_;
    std::vector<std::optional<hand::FingerTarget>> led_;
};

void check(const char* what, const Vec3& value) {
    if (!value.allFinite())
        throw Error({}, what, "has a component that is not a number", "Give three finite numbers.");
}

/// Factors on a body's inertia, weight and friction: beyond these bounds no result is meaningful.
void check_factor(const char* what, double value, double least) {
    constexpr double kMost = 1000;
    if (value >= least && value <= kMost) return;
    throw Error({}, what, fmt::format("is {}", value),
                fmt::format("Give a factor from {} to {}.", least, kMost));
}

session::Plan plan_of(const std::string& file, const std::string& rig,
                      const std::vector<std::string>& set, uint64_t seed) {
    session::Plan plan = session::make_plan(request_of(file, rig, set, seed));
    if (plan.task) {
        throw Error({file, 0}, "task", "has trials, which a world does not run",
                    "Give its scene, or do the trials with dihaptic.run().");
    }
    if (rig::is_real(plan.rig)) {
        throw Error(plan.rig.place, "devices", "are real, but a world is in virtual time",
                    "Leave the rig out, or choose one of simulated devices.");
    }
    return plan;
}

class World {
  public:
    World(const std::string& file, const std::string& rig, const std::vector<std::string>& set,
          uint64_t seed)
        : plan_(plan_of(file, rig, set, seed)), own_(plan_.driver) {
        begin();
    }

    /// Ensures that only one thread at a time steps or restarts the world.
    class Use {
      public:
        explicit Use(World& world) : world_(&world) {
            if (world.used_.exchange(true)) {
                throw Error(
                    "the world is being stepped",
                    "Wait until its step has returned; step_all() accepts each world once.");
            }
        }
        ~Use() {
            if (world_ != nullptr) world_->used_ = false;
        }
        Use(Use&& other) noexcept : world_(std::exchange(other.world_, nullptr)) {}
        Use& operator=(Use&&) = delete;

      private:
        World* world_;
    };

    /// Starts again, at time 0, with the initial hand and orders.
    void begin() {
        const Use use(*this);
        hand_ = std::make_shared<LedHand>(own_, plan_.scene.fingers.size());
        plan_.driver = hand_;
        servo_ = session::make_servo(plan_, session::open_devices(plan_));
        std::vector<recording::PhaseInfo> phases;
        for (const hand::Driver::Phase& phase : own_->phases())
            phases.push_back({phase.name, phase.start, phase.end});
        phases_.emplace(std::move(phases), plan_.settings.tick());
        loads_.clear();
        properties_.clear();
        placements_.clear();
        now_ = Time{0};
        servo_->activate();
        frame_ = nullptr;
    }

    /// Performs this many ticks; with a function, calls it in each, before the world moves.
    void step(int64_t ticks, const py::object& director) {
        if (ticks < 0) throw Error({}, "ticks", "are negative", "Give a number of ticks.");
        const Use use(*this);
        thrown_ = nullptr;
        if (director.is_none()) {
            run_alone(ticks);
        } else {
            const auto call = [&] { director(); };
            for (int64_t i = 0; i < ticks && !over() && !thrown_; ++i) tick(call);
        }
        if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
        if (over()) throw Error(why_over(), "Start again: World.reset().");
    }
    /// One step without Python, in a thread of step_all().
    void run(int64_t ticks) noexcept {
        for (int64_t i = 0; i < ticks && !over(); ++i) tick({});
    }
    /// While it is alone, no thread may read it or give it orders.
    void set_alone(bool alone) { alone_ = alone; }
    /// Whether it has stopped, or has switched force off for good.
    bool over() const { return servo_->stopped() || servo_->fault(); }

    py::object read(const std::string& list, size_t item, const std::string& name) const {
        return FrameValue(list, item, name).of(frame());
    }
    std::vector<std::vector<double>> rows(const std::string& list) const {
        return FrameRows(list).of(frame());
    }

    void lead(size_t finger, const Vec3& position, const Vec3& velocity,
              const std::optional<Eigen::Vector4d>& orientation) {
        may_be_ordered();
        check("position", position);
        check("velocity", velocity);
        hand::FingerTarget target;
        target.p_WT = position;
        target.v_WT = velocity;
        if (orientation) target.R_WT = quaternion(*orientation);
        hand_->lead(finger, target);
    }
    void let_go(size_t finger) {
        may_be_ordered();
        hand_->let_go(finger);
    }
    void place(int32_t body, const Vec3& position, const Eigen::Vector4d& orientation,
               const Vec3& velocity, const Vec3& angular_velocity) {
        may_be_ordered();
        check("position", position);
        check("velocity", velocity);
        check("angular_velocity", angular_velocity);
        std::erase_if(placements_, [&](const auto& p) { return p.body == body; });
        placements_.push_back(
            {body, {quaternion(orientation), position}, velocity, angular_velocity});
    }
    void push(int32_t body, const Vec3& force, const Vec3& torque) {
        may_be_ordered();
        check("force", force);
        check("torque", torque);
        constexpr double kMost = 1e4;
        if (force.norm() > kMost || torque.norm() > kMost)
            throw Error("the push is too strong", "Give at most 10 000 N, or N*m.");
        std::erase_if(loads_, [&](const auto& load) { return load.body == body; });
        if (force == Vec3::Zero() && torque == Vec3::Zero()) return;
        if (loads_.size() == frame::TaskFrame::kMostLoads) throw too_many("pushes");
        loads_.push_back({body, force, torque});
    }
    void scale(int32_t body, const Vec3& mass, double weight, double turning, double friction) {
        may_be_ordered();
        for (const double factor : mass) check_factor("mass", factor, 1e-3);
        check_factor("weight", weight, 0);
        check_factor("turning", turning, 1e-3);
        check_factor("friction", friction, 0);
        std::erase_if(properties_, [&](const auto& p) { return p.body == body; });
        if (mass == Vec3::Ones() && weight == 1 && turning == 1 && friction == 1) return;
        if (properties_.size() == frame::TaskFrame::kMostProperties)
            throw too_many("scaled bodies");
        frame::PropertiesFrame properties;
        properties.body = body;
        properties.mass_scale = mass;
        properties.weight_scale = weight;
        properties.turning_scale = turning;
        properties.friction_scale = friction;
        properties_.push_back(properties);
    }

    /// The numbers of observe() in a row; returns the end of the row.
    double* observe(double* out) const {
        const auto put = [&](const auto& vector) {
            for (const double value : vector) *out++ = value;
        };
        for (const frame::FingerFrame& finger : frame().fingers) {
            put(finger.p_WH);
            put(finger.v_WH);
            put(finger.f_sent_W);
            *out++ = finger.normal_force;
        }
        const int object = plan_.scene.object_index();
        const frame::BodyFrame body =
            object < 0 ? frame::BodyFrame{} : frame().bodies[static_cast<size_t>(object)];
        put(body.X_WB.p);
        put(std::array{body.X_WB.R.w(), body.X_WB.R.x(), body.X_WB.R.y(), body.X_WB.R.z()});
        put(body.v_WB);
        put(body.w_WB);
        return out;
    }
    static size_t observed(size_t fingers) { return 10 * fingers + 13; }

    Items items() const { return items_of(plan_); }
    size_t fingers() const { return plan_.scene.fingers.size(); }
    std::string object() const {
        const int index = plan_.scene.object_index();
        return index < 0 ? "" : plan_.scene.bodies[static_cast<size_t>(index)].name;
    }
    double duration() const { return own_->duration(); }
    double tick_length() const { return plan_.settings.tick(); }
    std::vector<std::string> warnings() const {
        std::vector<std::string> out;
        for (const Problem& warning : plan_.warnings) out.push_back(warning.text());
        return out;
    }

  private:
    /// Works without Python's lock, so that other threads may run meanwhile; checks now and then
    /// whether Ctrl-C was pressed.
    void run_alone(int64_t ticks) {
        constexpr int64_t kAsk = 1000;
        for (int64_t done = 0; done < ticks && !over(); done += kAsk) {
            {
                alone_ = true;
                const py::gil_scoped_release others_may_run;
                run(std::min(kAsk, ticks - done));
            }
            alone_ = false;
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        }
    }
    /// Throws Error while another thread steps the world.
    void may_be_ordered() const {
        if (alone_) throw Error("the world is being stepped", "Give orders between two steps.");
    }

    void tick(const std::function<void()>& call) noexcept {
        const auto direct = [&](const frame::Frame& last, std::span<const frame::Handle> handles,
                                frame::Commands& commands) {
            (*phases_)(last, handles, commands);
            if (call) {
                try {
                    call();
                } catch (...) {
                    thrown_ = std::current_exception();
                }
            }
            for (const auto& load : loads_) add(commands.task.loads, load);
            for (const auto& properties : properties_) add(commands.task.properties, properties);
            for (const auto& placement : placements_) add(commands.task.placements, placement);
            placements_.clear();
        };
        frame_ = &servo_->tick(now_, direct);
        now_ += servo_->period();
    }
    const frame::Frame& frame() const {
        if (alone_) throw Error("the world is being stepped", "Read it between two steps.");
        if (frame_ != nullptr) return *frame_;
        throw Error("no tick has been done yet", "Step the world first: World.step().");
    }
    std::string why_over() const {
        const haptics::Fault& fault = servo_->fault();
        if (!fault) return "the world has stopped";
        const size_t device = fault.device < 0 ? 0 : static_cast<size_t>(fault.device);
        return "the world has stopped: " + haptics::describe(fault,
                                                             plan_.scene.fingers[device].name,
                                                             plan_.devices[device].model);
    }
    static Quat quaternion(const Eigen::Vector4d& wxyz) {
        const Quat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
        if (!(std::abs(q.norm() - 1) < 1e-6)) {
            throw Error({}, "orientation", "is not a unit quaternion",
                        "Give w, x, y, z; (1, 0, 0, 0) turns nothing.");
        }
        return q.normalized();
    }
    static Error too_many(const char* what) {
        return Error(fmt::format("there are too many {}", what), "End some of them first.");
    }

    session::Plan plan_;
    std::shared_ptr<const hand::Driver> own_;
    std::shared_ptr<LedHand> hand_;
    std::unique_ptr<servo::Servo> servo_;
    std::optional<session::PhaseDirector> phases_;
    std::vector<frame::LoadFrame> loads_;
    std::vector<frame::PropertiesFrame> properties_;
    std::vector<frame::PlacementFrame> placements_;
    Time now_{0};
    const frame::Frame* frame_ = nullptr;
    std::exception_ptr thrown_;  // exception thrown by the director, in the tick
    std::atomic<bool> used_{false};
    bool alone_ = false;  // whether it is stepped without Python's lock
};

/// A row for each world: for each finger, the handle's position and velocity, the force on it, and
/// the force that presses its proxy; then the object's position, orientation, velocity, angular
/// velocity.
Array observe(const std::vector<World*>& worlds) {
    const size_t columns = worlds.empty() ? 0 : World::observed(worlds.front()->fingers());
    Array out({worlds.size(), columns});
    double* at = out.mutable_data();
    for (const World* world : worlds) at = world->observe(at);
    return out;
}

/// Leads all fingers of many worlds: rows of a world's fingers, each a position and a velocity.
void lead_all(const std::vector<World*>& worlds, const Array& targets) {
    const size_t fingers = worlds.empty() ? 0 : worlds.front()->fingers();
    if (targets.ndim() != 3 || targets.shape(0) != static_cast<py::ssize_t>(worlds.size()) ||
        targets.shape(1) != static_cast<py::ssize_t>(fingers) || targets.shape(2) != 6)
        throw Error("the targets do not match the worlds", "Give worlds x fingers x 6 numbers.");
    const double* at = targets.data();
    for (World* world : worlds) {
        for (size_t finger = 0; finger < fingers; ++finger, at += 6)
            world->lead(finger, Vec3(at[0], at[1], at[2]), Vec3(at[3], at[4], at[5]), {});
    }
}

void step_side_by_side(const std::vector<World*>& worlds, int64_t ticks, unsigned jobs) {
    const py::gil_scoped_release others_may_run;
    std::atomic<size_t> next{0};
    const auto work = [&] {
        for (size_t i = next++; i < worlds.size(); i = next++) worlds[i]->run(ticks);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::min<size_t>(jobs, worlds.size()); ++i) threads.emplace_back(work);
    work();
}

/// Steps many worlds, on this many processors.
void step_all(const std::vector<World*>& worlds, int64_t ticks, unsigned jobs) {
    if (ticks < 0) throw Error({}, "ticks", "are negative", "Give a number of ticks.");
    std::vector<World::Use> uses;  // which refuse a world that is listed twice
    for (World* world : worlds) uses.emplace_back(*world);
    for (World* world : worlds) world->set_alone(true);
    step_side_by_side(worlds, ticks, jobs);
    for (World* world : worlds) world->set_alone(false);
}

}  // namespace

void add_world(py::module_& m) {
    py::class_<World>(m, "World")
        .def(py::init<const std::string&, const std::string&, const std::vector<std::string>&,
                      uint64_t>())
        .def("begin", &World::begin)
        .def("step", &World::step)
        .def("over", &World::over)
        .def("read", &World::read)
        .def("rows", &World::rows)
        .def("lead", &World::lead)
        .def("let_go", &World::let_go)
        .def("place", &World::place)
        .def("push", &World::push)
        .def("scale", &World::scale)
        .def("items", &World::items)
        .def("object", &World::object)
        .def("duration", &World::duration)
        .def("tick_length", &World::tick_length)
        .def("warnings", &World::warnings);
    m.def("step_all", &step_all);
    m.def("observe", &observe);
    m.def("lead_all", &lead_all);
}

}  // namespace dihaptic::python
