#include "session/listeners/observers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <list>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/descriptor.h"
#include "base/json.h"
#include "base/latest.h"
#include "base/peer.h"
#include "base/plural.h"
#include "base/ring.h"
#include "base/text_file.h"
#include "base/unix_socket.h"
#include "session/knob_turner.h"
#include "session/plan.h"
#include "session/session_run.h"
#include "task/file/key_names.h"
#include "task/run/recorded.h"
#include "task/run/task_director.h"

namespace dihaptic::session {
namespace {

using Json = nlohmann::json;
using Wall = std::chrono::steady_clock;

constexpr Time kInterval = std::chrono::milliseconds(2);  // shortest interval between frames
constexpr int kBusy = 2, kIdle = 50;  // how often to look for frames, and for new observers [ms]
constexpr auto kLastPatience = std::chrono::seconds(1);  // wait for slow readers at the end
constexpr size_t kLongestMessage = 64 * 1024;            // [bytes]
constexpr size_t kMostObservers = 16;
constexpr const char* kNames = "dihaptic/session/";  // prefix of all socket names
constexpr int64_t kLongestName = 100;
constexpr size_t kMostWatched = 64;

/// Thrown when a request by an observer cannot be granted.
struct Refusal {
    std::string why;
};

/// Returns an unpredictable name: if the name could be guessed, another user could take it first.
std::string fresh_name() {
    std::array<unsigned char, 16> chance{};
    if (getrandom(chance.data(), chance.size(), 0) != static_cast<ssize_t>(chance.size()))
        return "";
    return fmt::format("{}{:02x}", kNames, fmt::join(chance, ""));
}

std::string name_file(const std::string& folder) {
    return folder + "/observers";
}

Error cannot_be_watched(const std::string& why) {
    return Error(fmt::format("No other program can watch this session: {}", why),
                 "The session runs nevertheless.");
}

/// Listens for new observers. The socket's address is abstract, so that leftovers of a killed
/// program are never in the way and so that the folder may be on any file system, with a path of
/// any length. The name is stored in a file of this user.
class Listening {
  public:
    explicit Listening(const std::string& folder)
        : file_(name_file(folder)), socket_(unix_socket(SOCK_SEQPACKET | SOCK_NONBLOCK)) {
        const std::string name = fresh_name();
        if (name.empty() || !socket_ || !UnixAddress::of_name(name).bind(socket_) ||
            listen(socket_.get(), 4) != 0 || !publish(name))
            throw cannot_be_watched(std::strerror(errno));
    }
    ~Listening() { unlink(file_.c_str()); }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;

    int descriptor() const { return socket_.get(); }
    /// Returns the socket of a new observer started by this user; it is not open if there is none.
    Descriptor accept() const {
        Descriptor newcomer(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
        const auto who = peer_of(newcomer.get());
        return who && who->is_trusted() ? std::move(newcomer) : Descriptor();
    }

  private:
    /// Writes the name to the file in which programs of this user look for it.
    bool publish(const std::string& name) const {
        const Descriptor file(::open(file_.c_str(),
                                     O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                     S_IRUSR | S_IWUSR));
        return file &&
               write(file.get(), name.data(), name.size()) == static_cast<ssize_t>(name.size());
    }

    std::string file_;
    Descriptor socket_;
};

struct Observer {
    Descriptor socket;
    std::vector<task::RecordedValue> values;
    Wall::duration every{};
    Wall::time_point due{};
    bool watches = false;

    explicit Observer(Descriptor newcomer) : socket(std::move(newcomer)) {}

    std::deque<Json> owed;  // messages that must not be lost, kept until there is room for them

    /// Sends a message. Returns whether there was room for the message; if an observer does not
    /// read, the message is lost.
    bool send(const Json& message) const {
        const std::string text =
            message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return ::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0;
    }
    /// Sends owed messages for as long as there is room.
    void settle() {
        while (!owed.empty() && send(owed.front())) owed.pop_front();
    }
};

/// An attempt at a trial that has ended.
struct Ended {
    int64_t tick = 0;
    double time = 0;
    int32_t trial = 0;
    int32_t attempt = 0;
    int32_t outcome = 0;
};

/// Sets a knob to the requested value; throws Refusal if the value is not allowed.
template <class T>
void turn(T& knob, const frame::Knob& is, const Json& value) {
    if constexpr (std::is_same_v<T, double>) {
        if (value.is_null() && is.unset != nullptr) {
            knob = kUnmeasured;
            return;
        }
        const double wanted = value.is_number() ? value.get<double>() : kUnmeasured;
        if (!(wanted >= is.least && wanted <= is.most))
            throw Refusal{fmt::format("{} must be a number from {:g} to {:g} {}.", is.name,
                                      is.least, is.most, is.unit)};
        knob = wanted;
    } else {
        const auto named = enum_named<T>(value.is_string() ? value.get<std::string>() : "");
        if (!named)
            throw Refusal{
                fmt::format("{} must be one of: {}.", is.name, fmt::join(enum_names(T{}), ", "))};
        knob = *named;
    }
}

/// What observers want of the session. The observers' thread asks, and the ticks do it.
class Requests {
  public:
    explicit Requests(const Opening& opening)
        : knobs_elsewhere_(opening.options.live != nullptr),
          knobs_(frame::Knobs::of(opening.plan.settings)) {
        turner_.prepare(opening.servo, opening.plan.scene);
    }

    // for the observers' thread; a request that cannot be granted throws Refusal
    void press(char key) { append(keys_, key, keys_pressed_); }
    void trigger(int code) { append(triggers_, code, triggers_sent_); }
    void turn_knobs(const Json& asked);
    void end() { end_ = true; }
    /// What was asked for during the session; "" if nothing was.
    std::string summary() const;

    // for the ticks
    void steer(const Steering& steering) noexcept;
    bool ends() const noexcept { return end_.load(std::memory_order_relaxed); }

  private:
    template <class T>
    static void append(ValueRing<T>& ring, T value, int64_t& count) {
        if (!ring.push(value))
            throw Refusal{"Too many requests wait for the session. Send them more slowly."};
        ++count;
    }

    static constexpr size_t kMostWaiting = 64;
    ValueRing<char> keys_{kMostWaiting};
    ValueRing<int> triggers_{kMostWaiting};
    KnobTurner turner_;
    std::atomic<bool> turned_{false};
    std::atomic<bool> end_{false};

    // used only by the observers' thread
    const bool knobs_elsewhere_;  // whether only the window may turn the knobs
    frame::Knobs knobs_;
    int64_t keys_pressed_ = 0, triggers_sent_ = 0, turns_ = 0;
};

class Observers : public Listener {
  public:
    explicit Observers(const Opening& opening);
    ~Observers() override { Observers::finish(); }

    void steer(const Steering& steering) noexcept override { requests_.steer(steering); }
    void take(const frame::Frame& frame) noexcept override;
    bool ends() const noexcept override { return requests_.ends(); }
    std::vector<std::string> finish() override;

  private:
    void run();
    void welcome();
    void say_goodbye();
    void hear(Observer& observer, const std::string& text);
    void watch(Observer& observer, const Json& asked);
    void request(const Json& asked);
    void look(Wall::time_point now);
    Json picture_of(const frame::Frame& frame, Observer& observer) const;
    Json name_of(const std::vector<std::string>& names, int32_t index) const {
        const auto i = static_cast<size_t>(index);
        return index < 0 || i >= names.size() ? Json() : Json(names[i]);
    }

    const scene::Scene& scene_;
    const std::string folder_;
    const bool real_;
    std::vector<std::string> states_;
    std::vector<std::string> outcomes_;

    Latest<frame::Frame> newest_;
    ValueRing<Ended> ends_{64};
    std::atomic<bool> watched_{false};
    Time shown_{0};
    Requests requests_;

    // used only by the observers' thread
    std::list<Observer> observers_;
    std::optional<Listening> listening_;
    std::atomic<bool> done_{false};
    std::thread thread_;
};

void Requests::turn_knobs(const Json& asked) {
    if (knobs_elsewhere_) throw Refusal{"The operator's window turns the knobs of this session."};
    frame::Knobs next = knobs_;
    for (const auto& [name, value] : asked.items()) {
        bool found = false;
        const std::string wanted = name;
        const Json& to = value;
        frame::Knobs::visit([&](auto member, const frame::Knob& is) {
            if (is.key == nullptr || wanted != is.name) return;
            turn(next.*member, is, to);
            found = true;
        });
        if (!found) {
            std::vector<std::string> names;
            frame::Knobs::visit([&](auto, const frame::Knob& is) {
                if (is.key != nullptr) names.emplace_back(is.name);
            });
            throw Refusal{
                fmt::format("There is no knob {}. Known: {}.", wanted, fmt::join(names, ", "))};
        }
    }
    turner_.publish(knobs_ = next);
    turned_ = true;
    ++turns_;
}

void Requests::steer(const Steering& steering) noexcept {
    while (const auto key = keys_.pop()) {
        if (steering.task != nullptr) steering.task->press(*key);
    }
    // a task takes one trigger in each tick
    if (const auto code = triggers_.pop(); code && steering.task != nullptr)
        steering.task->trigger(*code);
    if (turned_.load(std::memory_order_relaxed))
        turner_.turn(steering.last, seconds(steering.period), steering.commands.knobs);
}

std::string Requests::summary() const {
    if (keys_pressed_ + triggers_sent_ + turns_ == 0 && !end_) return "";
    return fmt::format("Other programs that watched the session steered it: {}, {}, {} of knobs{}.",
                       counted(keys_pressed_, "key"), counted(triggers_sent_, "trigger"),
                       counted(turns_, "turn"), end_ ? ", and its end" : "");
}

Observers::Observers(const Opening& opening)
    : scene_(opening.plan.scene),
      folder_(opening.folder.path()),
      real_(opening.real),
      outcomes_(opening.info.outcomes),
      requests_(opening) {
    for (const recording::PhaseInfo& phase : opening.info.phases) states_.push_back(phase.name);
    for (frame::Frame& frame : newest_.values()) opening.servo.reserve(frame);
    listening_.emplace(folder_);
    thread_ = std::thread([this] { run(); });
}

void Observers::run() {
    while (!done_) {
        std::vector<pollfd> waits{{listening_->descriptor(), POLLIN, 0}};
        for (const Observer& observer : observers_)
            waits.push_back({observer.socket.get(), POLLIN, 0});
        const bool busy = watched_.load(std::memory_order_relaxed);
        poll(waits.data(), waits.size(), busy ? kBusy : kIdle);
        auto wait = waits.begin() + 1;
        for (auto observer = observers_.begin(); observer != observers_.end(); ++wait) {
            bool gone = false;
            if (wait->revents != 0) {
                std::string text(kLongestMessage, '\0');
                const ssize_t size =
                    recv(observer->socket.get(), text.data(), text.size(), MSG_DONTWAIT);
                gone = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
                if (size > 0) hear(*observer, text.substr(0, static_cast<size_t>(size)));
            }
            observer = gone ? observers_.erase(observer) : std::next(observer);
        }
        if (waits.front().revents != 0) welcome();
        watched_ = !observers_.empty();
        look(Wall::now());
    }
    say_goodbye();
}

/// Tries for a limited time to send slow readers the messages that are still owed, then ends all
/// connections.
void Observers::say_goodbye() {
    look(Wall::time_point::max());
    const auto owes = [](const Observer& observer) { return !observer.owed.empty(); };
    const auto until = Wall::now() + kLastPatience;
    while (std::ranges::any_of(observers_, owes) && Wall::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(kBusy));
        for (Observer& observer : observers_) observer.settle();
    }
    for (const Observer& observer : observers_) observer.send({{"over", true}});
    observers_.clear();
}

void Observers::welcome() {
    Descriptor socket = listening_->accept();
    if (!socket) return;
    const Observer& newcomer = observers_.emplace_back(std::move(socket));
    if (observers_.size() > kMostObservers) {
        newcomer.send({{"refused", fmt::format("{} observers already watch.", kMostObservers)}});
        observers_.pop_back();
        return;
    }
    newcomer.send({{"session", folder_},
                   {"clock", real_ ? "real" : "virtual"},
                   {"states", states_},
                   {"outcomes", outcomes_}});
}

void Observers::hear(Observer& observer, const std::string& text) {
    try {
        const Json asked = parse_json(text);
        if (!asked.is_object()) throw Refusal{"A message is a JSON object: {\"key\": \"y\"}."};
        if (asked.contains("watch")) {
            watch(observer, asked);
        } else {
            request(asked);
        }
    } catch (const Refusal& refusal) {
        observer.send({{"refused", refusal.why}});
    }
}

void Observers::watch(Observer& observer, const Json& asked) {
    const Json& wanted = asked["watch"];
    const Json every = asked.value("every_ms", Json(20));
    if (!wanted.is_array() || wanted.size() > kMostWatched || !every.is_number() ||
        !(every.get<double>() >= 0 && every.get<double>() <= 60000))
        throw Refusal{
            fmt::format("'watch' must be a list of at most {} expressions, and 'every_ms' a "
                        "number from 0 to 60000.",
                        kMostWatched)};
    std::vector<task::RecordedValue> values;
    Json watching = Json::array();
    for (const Json& of : wanted) {
        if (!of.is_string()) throw Refusal{"Each expression is a text."};
        Diagnostics diagnostics;
        values.emplace_back(of.get<std::string>(), scene_, diagnostics);
        if (diagnostics.has_errors()) {
            const Problem& problem = diagnostics.problems().front();
            throw Refusal{
                fmt::format("{}: {}. {}", of.get<std::string>(), problem.what, problem.remedy)};
        }
        watching.push_back({{"of", of}, {"unit", values.back().unit()}});
    }
    observer.values = std::move(values);
    observer.every = std::chrono::duration_cast<Wall::duration>(
        std::chrono::duration<double, std::milli>(every.get<double>()));
    observer.watches = true;
    observer.send({{"watching", watching}});
}

void Observers::request(const Json& asked) {
    for (const auto& [what, value] : asked.items()) {
        const std::string text = value.is_string() ? value.get<std::string>() : "";
        if (const auto key = task::key_named(text); what == "key" && key) {
            requests_.press(*key);
        } else if (what == "trigger" && value.is_number_integer() && value >= 1 && value <= 255) {
            requests_.trigger(value.get<int>());
        } else if (what == "turn" && value.is_object()) {
            requests_.turn_knobs(value);
        } else if (what == "end" && value == true) {
            requests_.end();
        } else {
            throw Refusal{
                fmt::format("{}: {} is not understood. Valid keys are watch, key (one character, "
                            "Enter or Backspace), "
                            "trigger (1 to 255), turn (knobs) and end (true).",
                            what, value.dump())};
        }
    }
}

void Observers::look(Wall::time_point now) {
    while (const auto ended = ends_.pop()) {
        for (Observer& observer : observers_)
            observer.owed.push_back({{"tick", ended->tick},
                                     {"time_s", ended->time},
                                     {"ended",
                                      {{"trial_num", ended->trial},
                                       {"attempt", ended->attempt},
                                       {"outcome", name_of(outcomes_, ended->outcome)}}}});
    }
    for (Observer& observer : observers_) observer.settle();
    if (!newest_.is_new()) return;
    const auto is_due = [&](const Observer& observer) {
        return observer.watches && observer.owed.empty() && now >= observer.due;
    };
    if (std::ranges::none_of(observers_, is_due)) return;
    const frame::Frame& frame = newest_.read();
    for (Observer& observer : observers_) {
        if (!is_due(observer)) continue;
        observer.send(picture_of(frame, observer));
        observer.due = std::max(observer.due + observer.every, now - observer.every);
    }
}

Json Observers::picture_of(const frame::Frame& frame, Observer& observer) const {
    Json values = Json::array();
    for (task::RecordedValue& value : observer.values) {
        const double is = value(frame);
        values.push_back(std::isfinite(is) ? Json(is) : Json());
    }
    return {{"tick", frame.sequence},
            {"time_s", seconds(frame.time)},
            {"trial_num", frame.trial},
            {"attempt", frame.task.attempt},
            {"state", name_of(states_, frame.phase)},
            {"values", values}};
}

void Observers::take(const frame::Frame& frame) noexcept {
    if (!watched_.load(std::memory_order_relaxed)) return;
    if (frame.task.outcome >= 0)
        ends_.push({frame.sequence, seconds(frame.time), frame.trial, frame.task.attempt,
                    frame.task.outcome});
    if (frame.time - shown_ < kInterval) return;
    shown_ = frame.time;
    newest_.publish(frame);
}

std::vector<std::string> Observers::finish() {
    if (!thread_.joinable()) return {};
    done_ = true;
    thread_.join();
    listening_.reset();
    const std::string steered = requests_.summary();
    return steered.empty() ? std::vector<std::string>() : std::vector{steered};
}

}  // namespace

std::string socket_name(const std::string& folder) {
    const std::string name = read_text_file(name_file(folder), kLongestName);
    if (name.starts_with(kNames)) return name;
    throw Error({name_file(folder), 0}, "", "does not name a session's socket",
                "Remove it: a running session writes its own.");
}

std::unique_ptr<Listener> let_observe(const Opening& opening) {
    if (!opening.options.observers) return nullptr;
    return std::make_unique<Observers>(opening);
}

}  // namespace dihaptic::session
