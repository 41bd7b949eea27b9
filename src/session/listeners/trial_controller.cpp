#include "session/listeners/trial_controller.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "base/descriptor.h"
#include "base/json.h"
#include "base/peer.h"
#include "base/plural.h"
#include "base/text.h"
#include "base/unit.h"
#include "base/unix_socket.h"

namespace dihaptic::session {
namespace {

using Json = nlohmann::json;

constexpr double kPatience = 1;             // [s]
constexpr int kGreeting = 5000;             // longest time to wait for the greeting [ms]
constexpr size_t kLongestLine = 64 * 1024;  // [bytes]
constexpr size_t kMostMessages = 64;
constexpr size_t kMostNotes = 10;
constexpr size_t kLongestReason = 200;  // [bytes]
/// The time without an answer after which a message tells the user about the wait.
constexpr std::chrono::seconds kSilence{5};
constexpr std::chrono::seconds kReminder{20};  // after this time, the user is told again

Error refused(const std::string& socket, const std::string& what) {
    return Error({socket, 0}, "", what,
                 "First start the program that decides between trials; dihaptic.run() in Python "
                 "starts both.");
}

/// Shortens the reason for a failure to one line that is valid in any file.
std::string reason(std::string text) {
    if (text.size() > kLongestReason) {
        size_t end = kLongestReason;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
        text.resize(end);
    }
    return mended(text, Lines::one);
}

/// Reads and sends lines through a socket.
class LineReader {
  public:
    explicit LineReader(const std::string& path) : socket_(unix_socket(SOCK_STREAM)) {
        const auto address = UnixAddress::of_file(path);
        if (!address) throw refused(path, "is too long a path");
        if (!socket_ || !address->connect(socket_))
            throw refused(path, std::string("does not answer: ") + std::strerror(errno));
        if (const auto peer = peer_of(socket_.get()); !peer || !peer->is_trusted())
            throw refused(
                path, "belongs to another user: " + (peer ? peer->describe() : "unknown owner"));
    }

    /// Sends a line. If the reader has left or does not read, the line is lost.
    void send(const Json& line) const {
        const std::string text = line.dump() + "\n";
        ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
    /// Waits for a line for at most the given time; returns nullopt if none arrives. `gone` becomes
    /// true if no more lines can arrive.
    std::optional<std::string> read(std::chrono::microseconds wait, bool& gone) {
        if (auto line = take()) return line;
        pollfd what{socket_.get(), POLLIN, 0};
        const timespec time{0, static_cast<long>(wait.count()) * 1000};
        if (ppoll(&what, 1, &time, nullptr) <= 0) return std::nullopt;
        char bytes[4096];
        const ssize_t size = recv(socket_.get(), bytes, sizeof(bytes), 0);
        if (size > 0) read_.append(bytes, static_cast<size_t>(size));
        const bool again = size < 0 && (errno == EAGAIN || errno == EINTR);
        gone = (size <= 0 && !again) || read_.size() > kLongestLine;
        return take();
    }

  private:
    std::optional<std::string> take() {
        const size_t end = read_.find('\n');
        if (end == std::string::npos) return std::nullopt;
        std::string line = read_.substr(0, end);
        read_.erase(0, end + 1);
        return line;
    }
    Descriptor socket_;
    std::string read_;
};

/// A variable of the task, which is sent in its own unit.
struct Variable {
    std::string name;
    double si = 1;
};

}  // namespace

struct TrialController::Parts {
    std::string path;
    LineReader lines;
    std::vector<std::string> messages;
    int first_message = 0;  // index of the first of `messages` in the plan's list
    std::vector<std::string> outcomes;
    std::vector<Variable> variables;
    size_t trials = 0;
    std::optional<task::TrialControl> between;
    int64_t asked = 0;
    int asked_trial = 0;
    std::vector<std::string> notes;
    std::function<void(const std::string&)> waiting;
    std::chrono::steady_clock::time_point asked_at;
    std::chrono::steady_clock::duration
        told_after{};  // counted from asked_at; zero once the question has been answered
    std::atomic<bool> ended{false};
    std::thread thread;

    explicit Parts(const std::string& socket) : path(socket), lines(socket) {}

    void greet();
    void run(bool waits) noexcept;
    void ask(const task::Ended& ended_attempt);
    void take(const std::string& line);
    void set(const Json& values, task::Decision& out);
    void choose(const Json& json, task::Decision& out);
    void tell_of_silence();
    void decide(task::Decision out) {
        told_after = {};
        out.number = asked;
        between->decide(out);
    }
    void note(const std::string& what) {
        if (notes.size() < kMostNotes)
            notes.push_back(fmt::format(
                "The program that decides between trials {}, after trial {}.", what, asked_trial));
    }
};

void TrialController::Parts::greet() {
    bool gone = false;
    for (int waited = 0; waited < kGreeting && !gone; waited += 100) {
        const auto line = lines.read(std::chrono::milliseconds(100), gone);
        if (!line) continue;
        const Json json = parse_json(*line);
        if (!json.is_object() || !json.contains("messages") || !json["messages"].is_array() ||
            json["messages"].size() > kMostMessages)
            throw refused(path, "does not start with its messages");
        for (const Json& message : json["messages"]) {
            if (!message.is_string()) throw refused(path, "has a message that is not text");
            messages.push_back(message.get<std::string>());
            if (const auto fault = find_fault(messages.back()))
                throw refused(path, "has a message that " + fault->what);
        }
        return;
    }
    throw refused(path, "sent no greeting");
}

void TrialController::Parts::ask(const task::Ended& attempt) {
    Json values = Json::object();
    for (size_t i = 0; i < variables.size(); ++i) {
        const double value = attempt.variables[i] / variables[i].si;
        values[variables[i].name] = std::isfinite(value) ? Json(value) : Json();
    }
    asked = attempt.number;
    asked_trial = attempt.trial;
    asked_at = std::chrono::steady_clock::now();
    told_after = kSilence;
    lines.send(
        {{"number", attempt.number},
         {"trial_num", attempt.trial},
         {"attempt", attempt.attempt},
         {"outcome",
          attempt.outcome < 0 ? Json() : Json(outcomes[static_cast<size_t>(attempt.outcome)])},
         {"variables", values}});
}

void TrialController::Parts::set(const Json& values, task::Decision& out) {
    for (const auto& [name, value] : values.items()) {
        const auto found = std::ranges::find(variables, name, &Variable::name);
        if (found == variables.end()) {
            note(fmt::format("sets '{}', which is not a variable of the task", name));
        } else if (!value.is_number() || !std::isfinite(value.get<double>())) {
            note(fmt::format("sets {} to a value that is not a number", name));
        } else {
            out.variables[static_cast<size_t>(found - variables.begin())] =
                value.get<double>() * found->si;
        }
    }
}

/// Reads the choice of the next trial and of the message to show.
void TrialController::Parts::choose(const Json& json, task::Decision& out) {
    if (json.contains("next") && json["next"].is_number_integer()) {
        const auto next = json["next"].get<int64_t>();
        if (next >= 1 && next <= static_cast<int64_t>(trials)) {
            out.next = static_cast<int32_t>(next);
        } else {
            note(fmt::format("chooses trial {}, which does not exist", next));
        }
    }
    if (json.contains("message") && json["message"].is_number_integer()) {
        const auto message = json["message"].get<int64_t>();
        if (message >= 0 && message < static_cast<int64_t>(messages.size())) {
            out.message = first_message + static_cast<int>(message);
        } else {
            note(fmt::format("shows message {}, which does not exist", message));
        }
    }
}

void TrialController::Parts::take(const std::string& line) {
    const Json json = parse_json(line);
    if (!json.is_object() || !json.contains("number") || !json["number"].is_number_integer()) {
        note("sends an invalid answer");
        decide({});
        return;
    }
    if (json["number"].get<int64_t>() != asked)
        return;  // the answer is too late: the director has counted it as missing
    task::Decision out;
    if (json.contains("failed") && json["failed"].is_string())
        note(fmt::format("failed ({}): the trials continued as in the file",
                         reason(json["failed"].get<std::string>())));
    if (json.contains("set") && json["set"].is_object()) set(json["set"], out);
    choose(json, out);
    decide(out);
}

/// Tells the user about a long silence. On the virtual clock, the session stands still until the
/// answer arrives.
void TrialController::Parts::tell_of_silence() {
    const auto silent = std::chrono::steady_clock::now() - asked_at;
    if (told_after == told_after.zero() || silent < told_after || between->gone()) return;
    told_after += kReminder;
    if (!waiting) return;
    waiting(fmt::format(
        "The program that decides between trials has not answered for {:.0f} s, after trial {}. "
        "After {} s the session continues without it; Ctrl-C ends the session.",
        std::chrono::duration<double>(silent).count(), asked_trial,
        task::TrialControl::kLongest.count()));
}

void TrialController::Parts::run(bool waits) noexcept {
    const std::chrono::microseconds pause(waits ? 50 : 1000);
    bool gone = false;
    while (!ended && !gone) {
        if (const auto question = between->question()) ask(*question);
        if (const auto line = lines.read(pause, gone)) take(*line);
        if (waits) tell_of_silence();
    }
    if (gone) note("left: the trials continued as in the file");
    between->leave();
}

TrialController::TrialController(const std::string& socket)
    : parts_(std::make_unique<Parts>(socket)) {
    parts_->greet();
}

TrialController::~TrialController() {
    finish();
}

void TrialController::prepare(Plan& plan) {
    if (!plan.task) {
        throw Error({plan.file, 0}, "task",
                    "is missing: without trials, there is nothing to decide",
                    "Name an experiment with trials.");
    }
    auto task = std::make_shared<task::TaskPlan>(*plan.task);
    parts_->first_message = static_cast<int>(task->messages.size());
    for (const std::string& message : parts_->messages) {
        task->messages.push_back(message);
        task->numbers.emplace_back();
    }
    for (const task::TaskPlan::Outcome& outcome : task->outcomes)
        parts_->outcomes.push_back(outcome.name);
    for (const task::Variable& variable : task->task.variables)
        parts_->variables.push_back({variable.name, split_unit(variable.name).si});
    parts_->trials = task->trials.size();
    plan.task = task;
}

void TrialController::begin(const std::string& folder, bool waits,
                            std::function<void(const std::string&)> waiting) {
    parts_->waiting = std::move(waiting);
    Json names = Json::array();
    for (const Variable& variable : parts_->variables) names.push_back(variable.name);
    parts_->between.emplace(kPatience, waits);
    parts_->lines.send({{"session", folder},
                        {"outcomes", parts_->outcomes},
                        {"variables", names},
                        {"patience_s", kPatience}});
    parts_->thread = std::thread([this, waits] { parts_->run(waits); });
}

task::TrialControl* TrialController::between() const {
    return parts_->between ? &*parts_->between : nullptr;
}

std::vector<std::string> TrialController::finish() {
    parts_->ended = true;
    if (!parts_->thread.joinable()) return {};
    parts_->thread.join();
    std::vector<std::string> out = std::move(parts_->notes);
    const task::TrialControl& between = *parts_->between;
    if (between.late() > 0) {
        out.push_back(
            fmt::format("The program that decides between trials was too late {}, or had left: the "
                        "trials continued as in the file.",
                        counted(between.late(), "time")));
    }
    if (between.refused() > 0) {
        out.push_back(
            fmt::format("The program that decides between trials chose {} a trial that was not "
                        "left in the block: the next one in the file was done.",
                        counted(between.refused(), "time")));
    }
    return out;
}

}  // namespace dihaptic::session
