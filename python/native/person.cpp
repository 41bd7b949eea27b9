// A simulated person whose movements Python decides, on the virtual clock.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <atomic>
#include <exception>

#include "base/field_writer.h"
#include "base/number.h"
#include "frame/displayed.h"
#include "frame_values.h"
#include "parts.h"
#include "person/population.h"
#include "plans.h"
#include "session/listeners/trial_controller.h"
#include "session/record.h"
#include "session/rehearsal.h"
#include "session/unfinished_folder.h"
#include "task/file/key_names.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

/// Calls a Python function at a fixed interval of ticks with the display of the last tick, and
/// moves the fingers to their last targets.
class PythonHand : public task::SeeingDriver {
  public:
    PythonHand(const session::Plan& plan, py::function act, int every, std::atomic<bool>& stop)
        : own_(plan.driver),
          act_(std::move(act)),
          every_(every),
          stop_(stop),
          led_(plan.scene.fingers.size()) {}

    void lead(size_t finger, const Vec3& position, const Vec3& velocity) {
        if (finger >= led_.size() || !position.allFinite() || !velocity.allFinite())
            throw Error("a finger cannot be moved there", "Give three finite numbers.");
        led_[finger].emplace();
        led_[finger]->p_WT = position;
        led_[finger]->v_WT = velocity;
    }
    void press(char key) { key_ = key; }
    /// Raises any exception of act() again.
    void raise() {
        if (const std::exception_ptr thrown = std::exchange(thrown_, nullptr))
            std::rethrow_exception(thrown);
    }
    void forget() { act_ = py::function(); }

    const frame::Frame& frame() const {
        if (frame_ != nullptr) return *frame_;
        throw Error("nothing can be seen now", "Look within act().");
    }

    double duration() const override { return own_->duration(); }
    const std::vector<Phase>& phases() const override { return own_->phases(); }
    void restart() override { ticks_ = 0; }

  private:
    hand::FingerTarget do_target(int finger, double) const noexcept override {
        const auto& led = led_[static_cast<size_t>(finger)];
        return led ? *led : own_->target(finger, 0);
    }
    void do_see(const frame::Frame& frame) noexcept override {
        if (ticks_++ % every_ != 0 || thrown_) return;
        const py::gil_scoped_acquire python;
        frame_ = &frame;
        try {
            act_();
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        } catch (...) {
            thrown_ = std::current_exception();
            stop_ = true;
        }
        frame_ = nullptr;
    }
    char do_take_key() noexcept override { return std::exchange(key_, '\0'); }

    std::shared_ptr<const hand::Driver> own_;
    py::function act_;
    int64_t every_;
    std::atomic<bool>& stop_;
    std::vector<std::optional<hand::FingerTarget>> led_;
    char key_ = '\0';
    int64_t ticks_ = 0;
    const frame::Frame* frame_ = nullptr;
    std::exception_ptr thrown_;
};

/// A session done by a person written in Python.
class Sitting {
  public:
    Sitting(const std::string& file, const std::string& rig, const std::vector<std::string>& set,
            uint64_t seed, const std::string& participant)
        : participant_(recording::simulated_id(participant)),
          plan_(plan_of(file, rig, set, seed, participant_)) {
        if (plan_.task) return;
        throw Error({file, 0}, "task", "is missing: there are no trials to do",
                    "Name an experiment with trials.");
    }

    /// The person who does the trials, and the files and sockets of the session.
    struct Doing {
        std::string name;     ///< name of the person's class
        std::string traits;   ///< text of person.yaml
        std::string out;      ///< folder for session folders
        std::string between;  ///< socket of the program that decides between trials; empty: none
        bool keep_recordings = true;
    };

    /// A finished session.
    struct Done {
        std::string folder;
        bool good = false;
        std::vector<std::string> notes;
    };

    /// Does all trials. Afterwards thrown() returns any exception of act().
    Done run(const py::function& act, double every, const Doing& doing) {
        const int ticks = std::max(1, static_cast<int>(std::lround(every / plan_.settings.tick())));
        hand_ = std::make_shared<PythonHand>(plan_, act, ticks, stop_);
        plan_.driver = plan_.seeing = hand_;
        plan_.moved_by = {recording::Mover::simulated_person,
                          recording::program_version() + ", Python's " + doing.name, "",
                          number_text(plan_.seed)};
        plan_.person = doing.traits;
        plan_.resumable = false;
        session::RunOptions options;
        options.out = doing.out;
        options.command = "dihaptic.run(person=" + doing.name + ")";
        options.participant.id = participant_;
        options.keep_log = doing.keep_recordings;
        const Forgetting at_the_end{*hand_};
        const py::gil_scoped_release others_may_run;
        std::optional<session::TrialController> controller;
        if (!doing.between.empty()) {
            controller.emplace(doing.between);
            controller->prepare(plan_);
            options.controller = &*controller;
        }
        const session::Recorded session = session::record(plan_, options, stop_);
        return {session.folder, session.good(), session.notes};
    }
    /// Raises any exception of act() again.
    void raise() const {
        if (hand_) hand_->raise();
    }
    /// Makes a folder for a rehearsal of this experiment, or checks that it is one. `name`: name of
    /// its people's class; empty: they are drawn from a population file. `between`: name of the
    /// class that decides between trials; empty: none.
    void claim(const std::string& folder, const std::string& name, const std::string& population,
               const std::string& between, const session::Asked& asked) const {
        Node people = Node::mapping();
        if (name.empty()) {
            people = write_fields(person::population_of(population, person::Objects::device));
        } else {
            people.set("title", Node::of("Python's " + name));
        }
        session::Rehearsal rehearsal = session::rehearsal_of(plan_, std::move(people));
        rehearsal.between = between;
        rehearsal.asked = asked;
        session::claim(folder, rehearsal);
    }

    void lead(size_t finger, const Vec3& position, const Vec3& velocity) {
        hand_->lead(finger, position, velocity);
    }
    void press(const std::string& key) {
        const std::optional<char> named = task::key_named(key);
        if (!named)
            throw Error({}, "key", fmt::format("is '{}'", key),
                        "Press one character, \"Enter\" or \"Backspace\".");
        hand_->press(*named);
    }
    double time() const { return seconds(hand_->frame().time); }
    std::string state() const {
        const auto phase = static_cast<size_t>(hand_->frame().phase);
        return plan_.task->phases()[phase];
    }
    std::string message() const {
        const int32_t index = hand_->frame().task.message;
        return index < 0 ? "" : plan_.task->messages[static_cast<size_t>(index)];
    }
    py::object read(const std::string& list, size_t item, const std::string& name) const {
        return FrameValue(list, item, name).of(hand_->frame());
    }
    Vec3 shown_finger(size_t finger) const {
        return frame::displayed_handle(hand_->frame(), finger).p;
    }
    Vec3 shown_body(size_t body) const { return frame::displayed_body(hand_->frame(), body).p; }
    bool is_shown(size_t body) const { return frame::is_displayed(hand_->frame(), body); }
    /// The visible targets, by the names of their regions.
    std::vector<std::pair<std::string, Vec3>> targets() const {
        std::vector<std::pair<std::string, Vec3>> out;
        const frame::Frame& frame = hand_->frame();
        for (size_t i = 0; i < frame.task.targets.size(); ++i) {
            const auto region = static_cast<size_t>(frame.task.targets[i].region);
            out.emplace_back(plan_.task->task.regions[region].name,
                             frame::displayed_target(frame, i));
        }
        return out;
    }
    Items items() const { return items_of(plan_); }
    const std::string& participant() const { return participant_; }

  private:
    /// Releases act(), which holds the person, which holds this object: otherwise Python would free
    /// none of them.
    struct Forgetting {
        PythonHand& hand;
        ~Forgetting() { hand.forget(); }
    };

    static session::Plan plan_of(const std::string& file, const std::string& rig,
                                 const std::vector<std::string>& set, uint64_t seed,
                                 const std::string& participant) {
        session::Request request = request_of(file, rig, set, seed);
        request.participant = participant;
        request.simulate = true;
        return session::make_plan(request);
    }

    std::string participant_;
    session::Plan plan_;
    std::shared_ptr<PythonHand> hand_;
    std::atomic<bool> stop_{false};
};

}  // namespace

void add_person(py::module_& m) {
    m.def("person_id", &session::person_id);
    m.attr("most_people") = session::kMostPeople;
    py::class_<session::UnfinishedFolder>(m, "UnfinishedFolder")
        .def_static("take", &session::UnfinishedFolder::take)
        .def_property_readonly("path", &session::UnfinishedFolder::path)
        .def("is_done", &session::UnfinishedFolder::is_done)
        .def("finish", &session::UnfinishedFolder::finish)
        .def("remove", &session::UnfinishedFolder::remove);
    py::class_<Sitting>(m, "Sitting")
        .def(py::init<const std::string&, const std::string&, const std::vector<std::string>&,
                      uint64_t, const std::string&>())
        .def("run",
             [](Sitting& sitting, const py::function& act, double every, const std::string& name,
                const std::string& traits, const std::string& out, const std::string& between,
                bool keep_recordings) {
                 const auto done =
                     sitting.run(act, every, {name, traits, out, between, keep_recordings});
                 return py::make_tuple(done.folder, done.good, done.notes);
             })
        .def("raise_thrown", &Sitting::raise)
        .def("claim",
             [](const Sitting& sitting, const std::string& folder, const std::string& name,
                const std::string& population, const std::string& between, int asked,
                const std::string& command) {
                 sitting.claim(folder, name, population, between, {asked, 1, command});
             })
        .def("lead", &Sitting::lead)
        .def("press", &Sitting::press)
        .def("time", &Sitting::time)
        .def("state", &Sitting::state)
        .def("message", &Sitting::message)
        .def("read", &Sitting::read)
        .def("shown_finger", &Sitting::shown_finger)
        .def("shown_body", &Sitting::shown_body)
        .def("is_shown", &Sitting::is_shown)
        .def("targets", &Sitting::targets)
        .def("items", &Sitting::items)
        .def("participant", &Sitting::participant);
}

}  // namespace dihaptic::python
