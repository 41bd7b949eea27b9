#include "session/session_run.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <random>
#include <thread>

#include "base/field_writer.h"
#include "base/number.h"
#include "base/plural.h"
#include "base/shell_word.h"
#include "base/text.h"
#include "base/text_file.h"
#include "session/frozen_inputs.h"
#include "session/listeners/log.h"
#include "session/listeners/observers.h"
#include "session/listeners/outlets.h"
#include "session/listeners/sight.h"
#include "session/listeners/sounds.h"
#include "session/listeners/trial_controller.h"
#include "session/pacing.h"
#include "session/resume.h"
#include "session/session_director.h"
#include "task/plan/levels.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;
using Wall = std::chrono::steady_clock;

double since(Wall::time_point begin) {
    return std::chrono::duration<double>(Wall::now() - begin).count();
}

/// Longest duration of a session: a task that runs for longer must be waiting for an event that
/// never comes.
constexpr Time kLongest = std::chrono::hours(12);
constexpr Time kLongestTimed = std::chrono::hours(1);

std::vector<recording::PhaseInfo> phases_of(const hand::Driver& driver) {
    std::vector<recording::PhaseInfo> out;
    for (const hand::Driver::Phase& phase : driver.phases())
        out.push_back({phase.name, phase.start, phase.end});
    return out;
}

/// Describes the capabilities of the session's devices, in the order of the fingers.
std::vector<recording::DeviceRecord> records_of(const servo::Servo& servo,
                                                const scene::Scene& scene) {
    std::vector<recording::DeviceRecord> out;
    for (const scene::Finger& finger : scene.fingers) {
        out.push_back({servo.devices().descriptions()[out.size()], finger.name});
        // a device's name may contain arbitrary bytes
        out.back().model = mended(out.back().model, Lines::one);
        out.back().serial = mended(out.back().serial, Lines::one);
    }
    return out;
}

/// Throws Error if facts about a participant could not be read back from the session's record.
void check_words(const recording::Participant& participant, const char* what) {
    const std::string& id = participant.id;
    check_text(id, what);
    if (!id.empty() && std::string_view("=+-@").find(id.front()) != std::string_view::npos) {
        throw Error({what, 0}, shortened(id),
                    "starts with a character that a spreadsheet would take for a formula, if it "
                    "opens a table",
                    "Start with a letter or a digit, e.g. S07.");
    }
    check_text(participant.age, "age");
    check_text(participant.sex, "sex");
    check_text(participant.handedness, "handedness");
}

/// Throws Error if an entry for the session's record could not be read back from it.
void check_words(const Plan& plan, const RunOptions& options) {
    check_words(options.participant, "participant");
    check_words(options.partner, "partner");
    if (!options.partner.id.empty() && !is_for_two(plan))
        throw Error({"partner", 0}, options.partner.id, "has no hand: the task is for one person",
                    "Leave --partner out, or give the task two participants.");
    if (!options.partner.id.empty() && options.partner.id == options.participant.id)
        throw Error({"partner", 0}, options.partner.id, "is the participant's identifier too",
                    "Give the two participants different identifiers.");
    check_text(options.out, "folder for sessions");
    check_text(options.command, "command", Lines::several);
    check_text(plan.file, "experiment file");
    check_text(plan.title, "title", Lines::several);
}

/// Returns the identity of a session. On the virtual clock, it is computed from all of the
/// session's inputs, so that repeating a session gives the same files. On the real clock, it is
/// random.
std::string identity_of(const recording::Setup& setup, const Plan& plan, bool real) {
    if (real) {
        std::random_device random;
        return fmt::format("{:08x}{:08x}", random(), random());
    }
    std::string text = to_yaml(write_fields(setup));
    for (const task::Attempt& done : plan.done)
        text += fmt::format("{} {} {} ", done.trial, done.attempt, done.outcome);
    return fmt::format("{:016x}", recording::session_of(std::as_bytes(std::span(text))));
}

/// During its lifetime, calls `look` about ten times per second from a separate thread, and once
/// more at the end.
class Watcher {
  public:
    explicit Watcher(const std::function<void()>& look) {
        thread_ = std::thread([this, look] {
            std::unique_lock lock(mutex_);
            while (!done_) {
                condition_.wait_for(lock, std::chrono::milliseconds(100));
                look();
            }
        });
    }
    ~Watcher() {
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        condition_.notify_all();
        if (thread_.joinable()) thread_.join();
    }

  private:
    std::mutex mutex_;
    std::condition_variable condition_;
    bool done_ = false;
    std::thread thread_;
};

/// Waits for the end of a pause, then resumes the servo. If the devices cannot be activated,
/// reports the reason and waits again. Returns false when the session is to end.
bool wait_to_go_on(servo::Servo& servo, Live& live, const std::atomic<bool>& stop) {
    while (true) {
        while (live.paused && !stop && !live.ended)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (stop || live.ended) return false;
        try {
            servo.resume();
            return true;
        } catch (const Error& e) {
            live.tell(e.what());
        }
    }
}

/// Runs one session, from the creation of its folder to its last note; holds the data shared by the
/// servo's callbacks.
class Run {
  public:
    Run(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
        const Progress& progress, std::unique_ptr<devices::DeviceGroup> devices)
        : plan_(plan),
          options_(options),
          stop_(stop),
          progress_(progress),
          real_(options.clock == Clock::real),
          name_(fs::path(plan.file).stem().string()),
          earlier_(claim_earlier(plan, options)),
          folder_(recording::SessionFolder::create(
              options.out,
              options.participant.id.empty() ? name_ : name_ + "_" + options.participant.id)),
          live_(options.live),
          servo_(make_servo(plan, std::move(devices))),
          opening_{plan_, options_, folder_, info_, *servo_, real_} {}

    RunResult run();

  private:
    static std::optional<recording::SessionLock> claim_earlier(const Plan& plan,
                                                               const RunOptions& options) {
        if (plan.resumes.empty()) return std::nullopt;
        return claim(plan.resumes, options.out);
    }
    void prepare();
    void describe();
    void describe_task();
    void begin();
    void listen(std::unique_ptr<Listener> listener);
    void try_to_listen(std::unique_ptr<Listener> (*open)(const Opening&));
    void make_director();

    void take(const frame::Frame& frame) noexcept;
    bool asked_to_end() const noexcept;
    void run_ticks();
    void run_virtual_ticks(const frame::Director& director, const frame::FrameSink& sink);
    void run_real_ticks(const frame::Director& director, const frame::FrameSink& sink);
    double share() const noexcept;
    std::string fault_text() const;
    std::string stall_text(const servo::Timing::Stall& stall) const;

    void close_record();
    void note_how_it_ended();
    void conclude();

    const Plan& plan_;
    const RunOptions& options_;
    const std::atomic<bool>& stop_;
    const Progress& progress_;
    const bool real_;
    const std::string name_;
    std::optional<recording::SessionLock> earlier_;  // lock of the session that this one resumes
    const recording::SessionFolder folder_;
    Live* const live_;

    RunResult result_;
    recording::SessionInfo& info_ = result_.info;
    std::unique_ptr<servo::Servo> servo_;
    const Opening opening_;
    std::unique_ptr<Log> log_;
    std::vector<std::unique_ptr<Listener>> others_;
    std::vector<Listener*> listeners_;  // log_, others_ and the link to the watching thread
    std::optional<SessionDirector> director_;
    Time whole_{0};                    // session time at which the session is over
    std::atomic<int64_t> reached_{0};  // session time reached so far [ns]
};

RunResult Run::run() {
    result_.folder = folder_.path();
    prepare();
    try_to_listen(play_sounds);
    try_to_listen(let_observe);
    make_director();
    const auto begun = Wall::now();
    run_ticks();
    result_.elapsed = since(begun);
    servo_->deactivate();
    close_record();
    note_how_it_ended();
    conclude();
    result_.earlier = std::move(earlier_);
    return std::move(result_);
}

/// Writes the folder's first files and opens the session's resources. If this fails because of a
/// device, the disk, or an input that has changed in the meantime, the folder is removed, since no
/// tick has run yet.
void Run::prepare() {
    try {
        describe();
        begin();
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(folder_.path(), ignored);
        throw;
    }
}

void Run::describe() {
    info_.title = plan_.title.empty() ? name_ : plan_.title;
    info_.program = recording::program_version();
    info_.started = recording::iso_now();
    info_.command = options_.command;
    info_.experiment = plan_.file;
    info_.clock = real_ ? "real" : "virtual";
    info_.seed = number_text(plan_.seed);
    info_.participant = options_.participant;
    if (is_for_two(plan_)) {
        info_.partner = options_.partner;
        if (!plan_.resumes.empty())
            info_.partner = recording::SessionFolder::open_tables(plan_.resumes)
                                .read_info()
                                .partner.value_or(options_.partner);
        if (info_.partner->id.empty())
            info_.notes.emplace_back("the second participant of this task for two is not named");
    }
    info_.in_study = options_.in_study;
    info_.moved_by = plan_.moved_by;
    info_.study = plan_.study;
    if (const int object = plan_.scene.object_index(); object >= 0)
        info_.object = plan_.scene.bodies[static_cast<size_t>(object)].name;
    info_.devices = records_of(*servo_, plan_.scene);
    if (plan_.task) {
        describe_task();
    } else {
        info_.phases = phases_of(*plan_.driver);
    }
    for (const Problem& warning : plan_.warnings) info_.notes.push_back(warning.text());
    if (plan_.movement) {
        info_.notes.push_back(fmt::format("{:.1f} % of the movement was bridged",
                                          100 * plan_.movement->bridged_share));
    }
    info_.inputs = freeze_inputs(plan_, folder_);
    if (!plan_.resumes.empty()) {
        try {
            note_successor(plan_.resumes, folder_.path());
        } catch (const Error& e) {
            info_.notes.emplace_back(e.what());  // the earlier session is in a read-only archive
        }
    }
    info_.identity = identity_of(info_, plan_, real_);
    folder_.write_info(info_);
}

void Run::describe_task() {
    for (const std::string& phase : plan_.task->phases()) info_.phases.push_back({phase, 0, 0});
    for (const task::TaskPlan::Outcome& outcome : plan_.task->outcomes)
        info_.outcomes.push_back(outcome.name);
    info_.messages = plan_.task->messages;
    for (const task::Variable& variable : plan_.task->task.variables)
        info_.variables.push_back(variable.name);
    for (const task::LevelName& level : task::levels_of(plan_.task->task))
        info_.levels.push_back(level.name);
    for (const task::AskSpec& ask : task::questions_of(plan_.task->task))
        info_.answers.push_back(ask.name);
    info_.forms = task::forms_of(plan_.task->task);
    for (const task::TaskPlan::Page& page : plan_.task->pages)
        info_.pages.push_back(page.spec.picture.empty()
                                  ? page.spec.text
                                  : fs::path(page.spec.picture).filename().string());
    for (const task::SoundSpec& sound : plan_.task->task.sounds) info_.sounds.push_back(sound.name);
    info_.resumes = plan_.resumes;
}

/// Opens the log, the outlets and the devices.
void Run::begin() {
    log_ = std::make_unique<Log>(opening_);
    listeners_.push_back(log_.get());
    result_.lock.emplace(folder_);
    if (real_ || options_.sync > 0) folder_.sync();  // saves the inputs before the session begins
    listen(open_outlets(opening_));
    listen(show_to_person(opening_));
    servo_->activate();
    if (!options_.check) return;
    for (const Problem& warning : options_.check(servo_->devices()))
        info_.notes.push_back(warning.text());
    folder_.write_info(info_);
}

/// Adds a listener; `listener` is null if there is nothing for it to do in this session.
void Run::listen(std::unique_ptr<Listener> listener) {
    if (!listener) return;
    listeners_.push_back(listener.get());
    others_.push_back(std::move(listener));
}

/// Opens a listener. If this fails, notes the reason, and the session runs without that listener.
void Run::try_to_listen(std::unique_ptr<Listener> (*open)(const Opening&)) {
    try {
        listen(open(opening_));
    } catch (const Error& e) {
        info_.notes.emplace_back(e.what());
        if (options_.warn) options_.warn(info_.notes.back());
    }
}

/// Prepares everything before the first tick, since ticks do not allocate memory.
void Run::make_director() {
    whole_ = plan_.task ? kLongest : from_seconds(plan_.driver->duration());
    result_.timing.reserve(static_cast<size_t>(std::min(whole_, kLongestTimed) / servo_->period()) +
                           2);
    if (live_ != nullptr) {
        live_->prepare(*servo_, plan_.scene);
        live_->set_folder(folder_.path());
        listeners_.push_back(live_);
    }
    if (options_.controller != nullptr)
        options_.controller->begin(folder_.path(), !real_, options_.waiting);
    director_.emplace(opening_, stop_, listeners_);
}

void Run::take(const frame::Frame& frame) noexcept {
    for (Listener* listener : listeners_) listener->take(frame);
    reached_.store(frame.time.count(), std::memory_order_relaxed);
}

/// Whether a listener has requested the end of the session.
bool Run::asked_to_end() const noexcept {
    return std::ranges::any_of(listeners_, [](const Listener* l) { return l->ends(); });
}

void Run::run_ticks() {
    const frame::FrameSink sink = [this](const frame::Frame& frame) { take(frame); };
    const frame::Director director = std::ref(*director_);
    recording::ShowingsWriter showings(folder_);
    recording::HeadsWriter heads(folder_);
    recording::RemarksWriter remarks(folder_);
    std::optional<Watcher> watcher;
    watcher.emplace([&] {
        if (progress_) progress_(std::min(1.0, share()));
        // on the virtual clock, a tick may be waiting for the controller's answer
        if (options_.controller != nullptr && stop_) options_.controller->between()->leave();
        if (live_ == nullptr) return;
        if (asked_to_end()) live_->ended = true;  // also ends a pause
        while (const auto showing = live_->take_showing()) {
            if (real_) showings.add(*showing);  // a rehearsal has no viewer in real time
        }
        while (const auto head = live_->take_head()) {
            if (real_) heads.add(*head);
        }
        showings.flush();
        heads.flush();
        for (const recording::Remark& remark : live_->take_remarks(false)) remarks.add(remark);
    });
    if (real_) {
        run_real_ticks(director, sink);
    } else {
        run_virtual_ticks(director, sink);
    }
    watcher.reset();
    if (live_ == nullptr) return;
    for (const recording::Remark& remark : live_->take_remarks(true)) remarks.add(remark);
    if (remarks.lost() == 0) return;
    info_.notes.push_back(fmt::format(
        "{} of the operator could not be written into notes.csv. The window's log has the text: "
        "add it to note.txt (File > Recorded sessions > Note).",
        counted(remarks.lost(), "note")));
}

/// Runs the ticks; if somebody watches the session, at the pace that the viewer chose.
void Run::run_virtual_ticks(const frame::Director& director, const frame::FrameSink& sink) {
    std::optional<Pacing> pacing;
    if (live_ != nullptr) pacing.emplace(*live_, stop_);
    const frame::FrameSink paced = [&](const frame::Frame& frame) {
        sink(frame);
        if (pacing) pacing->wait(frame.time);
    };
    servo::run_virtual(*servo_, director, paced, whole_, stop_, &result_.timing.ticks);
}

/// Runs the ticks in one go or, if an operator controls the session, in parts that end at each
/// pause or fault.
void Run::run_real_ticks(const frame::Director& director, const frame::FrameSink& sink) {
    const auto stuck = [this](const servo::Timing::Stall& stall) {
        if (options_.stuck) options_.stuck(stall_text(stall));
    };
    const std::atomic<bool> never{false};  // the director stops the session in a last tick
    Time first{0};
    while (true) {
        servo::run_real(*servo_, director, sink, first, whole_, never, result_.timing, stuck);
        servo_->rest();
        if (live_ == nullptr) return;
        if (servo_->fault() && !stop_) {
            info_.notes.push_back(fault_text());
            director_->interrupt();
            live_->tell(info_.notes.back());
        } else if (!servo_->resting()) {
            return;
        } else {
            director_->interrupt();
        }
        first = result_.timing.reached + servo_->period();
        if (first > whole_ || !wait_to_go_on(*servo_, *live_, stop_)) return;
    }
}

double Run::share() const noexcept {
    if (const auto of_trials = director_->share()) return *of_trials;
    return static_cast<double>(reached_.load(std::memory_order_relaxed)) /
           static_cast<double>(std::max<int64_t>(1, whole_.count()));
}

std::string Run::stall_text(const servo::Timing::Stall& stall) const {
    return fmt::format(
        "{}. The call has not returned since, so the session ends here. Switch the devices off and "
        "on; 'dihaptic recover {}' makes the session's files.",
        servo::describe(stall), shell_file(folder_.path()));
}

std::string Run::fault_text() const {
    const haptics::Fault& fault = servo_->fault();
    const size_t device = fault.device < 0 ? 0 : static_cast<size_t>(fault.device);
    std::string out =
        haptics::describe(fault, info_.devices[device].finger, info_.devices[device].model);
    if (const std::string said = servo_->devices().explain(static_cast<int>(device));
        fault.device >= 0 && !said.empty())
        out += " Its driver reports: " + said;
    const bool stopped = fault.kind == haptics::FaultKind::stopped;
    if (!stopped) out += " The last second before the fault is in fault.csv.";
    if (live_ != nullptr) return out;  // the window tells the user what to do next
    if (plan_.task && plan_.resumable) {
        out += fmt::format(" 'dihaptic resume {}' continues with the remaining trials.",
                           shell_file(folder_.path()));
    } else if (!plan_.task && !stopped) {
        out += " Then start the session again.";
    }
    return out;
}

void Run::close_record() {
    for (Listener* listener : listeners_) {
        for (const std::string& message : listener->finish()) info_.notes.push_back(message);
    }
    result_.ticks = log_->frames();
    result_.dropped = log_->dropped();
    if (options_.controller != nullptr) {
        result_.undecided = options_.controller->finish();
        info_.notes.insert(info_.notes.end(), result_.undecided.begin(), result_.undecided.end());
    }
    result_.simulated = seconds(Time(reached_.load()));
    if (plan_.open_ended()) info_.phases.back().end = result_.simulated;
}

void Run::note_how_it_ended() {
    // an open-ended session, moved by a mouse or a person, is complete whenever it ends
    const bool unfinished = plan_.task ? director_->trials_left() : !plan_.open_ended();
    result_.interrupted = stop_.load() || (asked_to_end() && unfinished);
    if (servo_->fault()) {
        result_.fault = fault_text();
        // if the session waited for a remedy, the fault is already in the notes
        if (info_.notes.empty() || info_.notes.back() != result_.fault)
            info_.notes.push_back(result_.fault);
    }
    if (const std::string bounded = director_->bounded(); !bounded.empty())
        info_.notes.push_back(bounded);
    if (const std::string wait = director_->endless_wait(info_.phases); !wait.empty()) {
        result_.interrupted = true;
        result_.fault = wait;
        info_.notes.push_back(wait);
    }
    if (result_.timing.stall) {
        result_.stall = servo::describe(*result_.timing.stall);
        info_.notes.push_back(result_.stall);
    }
    if (result_.timing.pauses > 0) info_.notes.push_back(servo::describe_pauses(result_.timing));
}

/// Writes the final state. On the disk, the state stays `running` until the session's other files
/// exist.
void Run::conclude() {
    if (progress_ && !result_.interrupted) progress_(1);
    info_.ticks = static_cast<int>(result_.ticks + result_.dropped);
    info_.interrupted = result_.interrupted;
    info_.finished =
        fmt::format("{}, {}, {} not recorded", counted(info_.ticks, "tick"),
                    counted(result_.timing.overruns, "overrun"), counted(result_.dropped, "frame"));
    if (real_) info_.finished += "; " + servo::describe(result_.timing);
    if (result_.timing.refusals.any()) {
        info_.notes.push_back(
            servo::describe(result_.timing.refusals, plan_.settings.real_time_priority));
    }
    if (const size_t left_out = director_->left_out(); left_out > 0) {
        info_.notes.push_back(fmt::format("an exit ended the session: {} {} left out",
                                          counted(static_cast<int64_t>(left_out), "trial"),
                                          left_out == 1 ? "was" : "were"));
    }
    if (std::string missed = director_->missed_placements(); !missed.empty())
        info_.notes.push_back(std::move(missed));
    folder_.write_info(info_);
    // a fault also ends a session; `dihaptic resume` does the remaining trials
    const bool cut_short = servo_->fault() && director_->trials_left();
    info_.state = result_.interrupted || cut_short ? recording::SessionState::interrupted
                                                   : recording::SessionState::complete;
}

}  // namespace

RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress, std::unique_ptr<devices::DeviceGroup> devices) {
    if (options.clock != Clock::real && rig::is_real(plan.rig)) {
        throw Error(plan.rig.place, "devices", "are real, and run in real time",
                    "Run them on the real clock, or choose a rig of simulated devices.");
    }
    check_words(plan, options);
    if (devices != nullptr) return Run(plan, options, stop, progress, std::move(devices)).run();
    Plan opened = plan;
    devices = open_devices(opened);
    return Run(opened, options, stop, progress, std::move(devices)).run();
}

}  // namespace dihaptic::session
