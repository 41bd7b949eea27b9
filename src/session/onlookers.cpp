#include "session/onlookers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <deque>
#include <list>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/json.h"
#include "base/latest.h"
#include "base/peer.h"
#include "base/plural.h"
#include "base/ring.h"
#include "base/text_file.h"
#include "session/knob_turner.h"
#include "task/run/recorded.h"

namespace dihaptic::session {
namespace {

using Json = nlohmann::json;
using Wall = std::chrono::steady_clock;

constexpr Time kInterval = std::chrono::milliseconds(2);  // shortest, between frames
constexpr int kBusy = 2, kIdle = 50;  // interval of checks, for frames and for newcomers [ms]
constexpr auto kLastPatience =
    std::chrono::seconds(1);                   // patience with readers after the session's end
constexpr size_t kLongestMessage = 64 * 1024;  // [bytes]
constexpr size_t kMostOnlookers = 16;
constexpr const char* kNames = "dihaptic/session/";  // prefix of all names
constexpr int64_t kLongestName = 100;
constexpr size_t kMostWatched = 64;

/// A request by an onlooker that cannot be granted.
struct Refusal {
    std::string why;
};

/// An unpredictable name: another user would otherwise take it first.
std::string fresh_name() {
    std::array<unsigned char, 16> chance{};
    if (getrandom(chance.data(), chance.size(), 0) != static_cast<ssize_t>(chance.size()))
        return "";
    return fmt::format("{}{:02x}", kNames, fmt::join(chance, ""));
}

std::string name_file(const std::string& folder) {
    return folder + "/onlookers";
}

Error cannot_be_watched(const std::string& why) {
    return Error(fmt::format("No other program can watch this session: {}", why),
                 "The session runs nevertheless.");
}

/// The socket's address is abstract: a killed program leaves none behind that is in the way, and
/// the folder may be on any file system, with a path of any length. A file of this user contains
/// the name.
class Listening {
  public:
    explicit Listening(const std::string& folder)
        : file_(name_file(folder)),
          socket_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string name = fresh_name();
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        const auto* const at = reinterpret_cast<const sockaddr*>(&address);
        if (!name.empty() && socket_ >= 0 && bind(socket_, at, size) == 0 &&
            listen(socket_, 4) == 0 && publish(name))
            return;
        const std::string why = std::strerror(errno);
        if (socket_ >= 0) close(socket_);
        throw cannot_be_watched(why);
    }
    ~Listening() {
        unlink(file_.c_str());
        close(socket_);
    }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;

    int descriptor() const { return socket_; }
    /// The socket of a newcomer started by this user, if any; else -1.
    int accept() const {
        const int newcomer = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        if (newcomer < 0) return -1;
        if (const auto who = peer_of(newcomer); who && who->is_trusted()) return newcomer;
        close(newcomer);
        return -1;
    }

  private:
    /// Writes the name to the file in which this user's programs look for it.
    bool publish(const std::string& name) const {
        const int file = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                S_IRUSR | S_IWUSR);
        if (file < 0) return false;
        const bool written =
            write(file, name.data(), name.size()) == static_cast<ssize_t>(name.size());
        const int why = errno;
        close(file);
        errno = why;
        return written;
    }

    std::string file_;
    int socket_;
};

struct Onlooker {
    int socket;
    std::vector<task::RecordedValue> values;
    Wall::duration every{};
    Wall::time_point due{};
    bool watches = false;

    explicit Onlooker(int descriptor) : socket(descriptor) {}
    ~Onlooker() { close(socket); }
    Onlooker(const Onlooker&) = delete;
    Onlooker& operator=(const Onlooker&) = delete;

    std::deque<Json> owed;  // messages that must not be lost, until there is room for them

    /// Returns whether there was room for the message; an onlooker that does not read loses it.
    bool send(const Json& message) const {
        const std::string text =
            message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0;
    }
    /// Sends owed messages, as far as there is room.
    void settle() {
        while (!owed.empty() && send(owed.front())) owed.pop_front();
    }
};

/// An attempt at a trial that ended.
struct Ended {
    int64_t tick = 0;
    double time = 0;
    int32_t trial = 0;
    int32_t attempt = 0;
    int32_t outcome = 0;
};

/// Sets a knob as requested; throws Refusal.
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

}  // namespace

struct Onlookers::Parts {
    Parts(const Plan& of, std::string in, bool on_real_clock, bool window_has_knobs)
        : plan(of),
          folder(std::move(in)),
          real(on_real_clock),
          knobs_elsewhere(window_has_knobs),
          knobs(frame::Knobs::of(of.settings)) {}

    const Plan& plan;
    const std::string folder;
    const bool real;
    const bool knobs_elsewhere;
    std::vector<std::string> states;
    std::vector<std::string> outcomes;

    Latest<frame::Frame> newest;
    ValueRing<Ended> ends{64};
    std::atomic<bool> watched{false};
    Time shown{0};
    KnobTurner turner;
    std::atomic<bool> turned{false};
    std::atomic<char> key{0};
    std::atomic<int> trigger{0};
    std::atomic<bool> end{false};

    // used by the thread
    frame::Knobs knobs;
    std::list<Onlooker> onlookers;
    size_t came = 0, keys = 0, triggers = 0, turns = 0;
    std::optional<Listening> listening;
    std::atomic<bool> done{false};
    std::thread thread;

    void run();
    void welcome();
    void say_goodbye();
    void hear(Onlooker& onlooker, const std::string& text);
    void watch(Onlooker& onlooker, const Json& asked);
    void steer(const Json& asked);
    void turn_knobs(const Json& asked);
    void look(Wall::time_point now);
    Json picture_of(const frame::Frame& frame, Onlooker& onlooker) const;
    Json name_of(const std::vector<std::string>& names, int32_t index) const {
        const auto i = static_cast<size_t>(index);
        return index < 0 || i >= names.size() ? Json() : Json(names[i]);
    }
};

void Onlookers::Parts::run() {
    while (!done) {
        std::vector<pollfd> waits{{listening->descriptor(), POLLIN, 0}};
        for (const Onlooker& onlooker : onlookers) waits.push_back({onlooker.socket, POLLIN, 0});
        const bool busy = watched.load(std::memory_order_relaxed);
        poll(waits.data(), waits.size(), busy ? kBusy : kIdle);
        auto wait = waits.begin() + 1;
        for (auto onlooker = onlookers.begin(); onlooker != onlookers.end(); ++wait) {
            bool gone = false;
            if (wait->revents != 0) {
                std::string text(kLongestMessage, '\0');
                const ssize_t size = recv(onlooker->socket, text.data(), text.size(), MSG_DONTWAIT);
                gone = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
                if (size > 0) hear(*onlooker, text.substr(0, static_cast<size_t>(size)));
            }
            onlooker = gone ? onlookers.erase(onlooker) : std::next(onlooker);
        }
        if (waits.front().revents != 0) welcome();
        watched = !onlookers.empty();
        look(Wall::now());
    }
    say_goodbye();
}

/// Sends slow readers their owed messages, for a while.
void Onlookers::Parts::say_goodbye() {
    look(Wall::time_point::max());
    const auto owes = [](const Onlooker& onlooker) { return !onlooker.owed.empty(); };
    const auto until = Wall::now() + kLastPatience;
    while (std::ranges::any_of(onlookers, owes) && Wall::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(kBusy));
        for (Onlooker& onlooker : onlookers) onlooker.settle();
    }
    for (const Onlooker& onlooker : onlookers) onlooker.send({{"over", true}});
    onlookers.clear();
}

void Onlookers::Parts::welcome() {
    const int socket = listening->accept();
    if (socket < 0) return;
    const Onlooker& newcomer = onlookers.emplace_back(socket);
    if (onlookers.size() > kMostOnlookers) {
        newcomer.send({{"refused", fmt::format("{} onlookers already watch.", kMostOnlookers)}});
        onlookers.pop_back();
        return;
    }
    ++came;
    newcomer.send({{"session", folder},
                   {"clock", real ? "real" : "virtual"},
                   {"states", states},
                   {"outcomes", outcomes}});
}

void Onlookers::Parts::hear(Onlooker& onlooker, const std::string& text) {
    try {
        const Json asked = parse_json(text);
        if (!asked.is_object()) throw Refusal{"A message is a JSON object: {\"key\": \"y\"}."};
        if (asked.contains("watch")) {
            watch(onlooker, asked);
        } else {
            steer(asked);
        }
    } catch (const Refusal& refusal) {
        onlooker.send({{"refused", refusal.why}});
    }
}

void Onlookers::Parts::watch(Onlooker& onlooker, const Json& asked) {
    const Json& wanted = asked["watch"];
    const Json every = asked.value("every_ms", Json(20));
    if (!wanted.is_array() || wanted.size() > kMostWatched || !every.is_number() ||
        !(every.get<double>() >= 0 && every.get<double>() <= 60000))
        throw Refusal{
            fmt::format("watch is a list of at most {} expressions, and every_ms a "
                        "number from 0 to 60000.",
                        kMostWatched)};
    std::vector<task::RecordedValue> values;
    Json watching = Json::array();
    for (const Json& of : wanted) {
        if (!of.is_string()) throw Refusal{"Each expression is a text."};
        Diagnostics diagnostics;
        values.emplace_back(of.get<std::string>(), plan.scene, diagnostics);
        if (diagnostics.has_errors()) {
            const Problem& problem = diagnostics.problems().front();
            throw Refusal{
                fmt::format("{}: {}. {}", of.get<std::string>(), problem.what, problem.remedy)};
        }
        watching.push_back({{"of", of}, {"unit", values.back().unit()}});
    }
    onlooker.values = std::move(values);
    onlooker.every = std::chrono::duration_cast<Wall::duration>(
        std::chrono::duration<double, std::milli>(every.get<double>()));
    onlooker.watches = true;
    onlooker.send({{"watching", watching}});
}

void Onlookers::Parts::steer(const Json& asked) {
    for (const auto& [what, value] : asked.items()) {
        const std::string text = value.is_string() ? value.get<std::string>() : "";
        if (what == "key" && text.size() == 1) {
            key = text[0];
            ++keys;
        } else if (what == "trigger" && value.is_number_integer() && value >= 1 && value <= 255) {
            trigger = value.get<int>();
            ++triggers;
        } else if (what == "turn" && value.is_object()) {
            turn_knobs(value);
        } else if (what == "end" && value == true) {
            end = true;
        } else {
            throw Refusal{
                fmt::format("{}: {} is not understood. Valid keys are watch, key (one character), "
                            "trigger (1 to 255), turn (knobs) and end (true).",
                            what, value.dump())};
        }
    }
}

void Onlookers::Parts::turn_knobs(const Json& asked) {
    if (knobs_elsewhere) throw Refusal{"The operator's window turns the knobs of this session."};
    frame::Knobs next = knobs;
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
    turner.publish(knobs = next);
    turned = true;
    ++turns;
}

void Onlookers::Parts::look(Wall::time_point now) {
    while (const auto ended = ends.pop()) {
        for (Onlooker& onlooker : onlookers)
            onlooker.owed.push_back({{"tick", ended->tick},
                                     {"time_s", ended->time},
                                     {"ended",
                                      {{"trial_num", ended->trial},
                                       {"attempt", ended->attempt},
                                       {"outcome", name_of(outcomes, ended->outcome)}}}});
    }
    for (Onlooker& onlooker : onlookers) onlooker.settle();
    if (!newest.is_new()) return;
    const auto is_due = [&](const Onlooker& onlooker) {
        return onlooker.watches && onlooker.owed.empty() && now >= onlooker.due;
    };
    if (std::ranges::none_of(onlookers, is_due)) return;
    const frame::Frame& frame = newest.read();
    for (Onlooker& onlooker : onlookers) {
        if (!is_due(onlooker)) continue;
        onlooker.send(picture_of(frame, onlooker));
        onlooker.due = std::max(onlooker.due + onlooker.every, now - onlooker.every);
    }
}

Json Onlookers::Parts::picture_of(const frame::Frame& frame, Onlooker& onlooker) const {
    Json values = Json::array();
    for (task::RecordedValue& value : onlooker.values) {
        const double is = value(frame);
        values.push_back(std::isfinite(is) ? Json(is) : Json());
    }
    return {{"tick", frame.sequence},
            {"time_s", seconds(frame.time)},
            {"trial_num", frame.trial},
            {"attempt", frame.task.attempt},
            {"state", name_of(states, frame.phase)},
            {"values", values}};
}

std::string socket_name(const std::string& folder) {
    const std::string name = read_text_file(name_file(folder), kLongestName);
    if (name.starts_with(kNames)) return name;
    throw Error({name_file(folder), 0}, "", "does not name a session's socket",
                "Remove it: a running session writes its own.");
}

Onlookers::Onlookers(const Plan& plan, const std::string& folder, bool real, bool knobs_elsewhere)
    : parts_(std::make_unique<Parts>(plan, folder, real, knobs_elsewhere)) {}

Onlookers::~Onlookers() {
    finish();
}

void Onlookers::open(const servo::Servo& servo, const std::vector<std::string>& states,
                     const std::vector<std::string>& outcomes) {
    parts_->states = states;
    parts_->outcomes = outcomes;
    parts_->turner.prepare(servo, parts_->plan.scene);
    for (frame::Frame& frame : parts_->newest.values()) servo.reserve(frame);
    parts_->listening.emplace(parts_->folder);
    parts_->thread = std::thread([this] { parts_->run(); });
}

void Onlookers::show(const frame::Frame& frame) noexcept {
    if (!parts_->watched.load(std::memory_order_relaxed)) return;
    if (frame.task.outcome >= 0)
        parts_->ends.push({frame.sequence, seconds(frame.time), frame.trial, frame.task.attempt,
                           frame.task.outcome});
    if (frame.time - parts_->shown < kInterval) return;
    parts_->shown = frame.time;
    parts_->newest.publish(frame);
}

char Onlookers::take_key() noexcept {
    return parts_->key.exchange(0, std::memory_order_relaxed);
}

int Onlookers::take_trigger() noexcept {
    return parts_->trigger.exchange(0, std::memory_order_relaxed);
}

bool Onlookers::ended() const noexcept {
    return parts_->end.load(std::memory_order_relaxed);
}

void Onlookers::turn_knobs(const frame::Frame& last, double h, frame::Knobs& now) noexcept {
    if (parts_->turned.load(std::memory_order_relaxed)) parts_->turner.turn(last, h, now);
}

std::vector<std::string> Onlookers::finish() {
    Parts& p = *parts_;
    if (!p.thread.joinable()) return {};
    p.done = true;
    p.thread.join();
    p.listening.reset();
    if (p.keys + p.triggers + p.turns == 0 && !p.end) return {};
    return {
        fmt::format("Other programs that watched the session steered it: {}, {}, {} of knobs{}.",
                    counted(static_cast<int64_t>(p.keys), "key"),
                    counted(static_cast<int64_t>(p.triggers), "trigger"),
                    counted(static_cast<int64_t>(p.turns), "turn"), p.end ? ", and its end" : "")};
}

}  // namespace dihaptic::session
