#include "sound/player.h"

#include <fmt/format.h>

#include "sound/sink.h"

namespace dihaptic::sound {
namespace {

constexpr auto kTend = std::chrono::milliseconds(20);

std::unique_ptr<Sink> open_sink(const Player::Plan& plan, const recording::SessionFolder& folder) {
    if (plan.output.to == display::SoundTo::file)
        return open_file(plan.sounds, plan.seed, plan.output, folder.file("sound.wav"));
    return open_speakers(plan.sounds, plan.seed, plan.output);
}

}  // namespace

std::vector<Wave> make_waves(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                             double rate) {
    std::vector<Wave> out;
    out.reserve(sounds.size());
    for (const task::SoundSpec& sound : sounds) out.push_back(make_wave(sound, rate, seed));
    return out;
}

void check(const std::vector<task::SoundSpec>& sounds, const display::SoundOutput& output,
           Diagnostics& diagnostics) {
    for (const task::SoundSpec& sound : sounds) {
        if (sound.tone && *sound.tone >= output.rate / 2)
            diagnostics.error(sound.place, "tone",
                              fmt::format("{:g} Hz is too high for {:g} samples a second",
                                          *sound.tone, output.rate),
                              "Lower it, or raise rate_Hz under 'sound' in the rig.");
        if (sound.file.empty()) continue;
        try {
            make_wave(sound, output.rate, 0);
        } catch (const Error& e) {
            diagnostics.add(e.problems());
        }
    }
}

Player::Player(const Plan& plan, const recording::SessionFolder& folder)
    : sink_(open_sink(plan, folder)), hearings_(folder), real_(plan.real) {
    for (const task::SoundSpec& sound : plan.sounds) names_.push_back(sound.name);
    if (real_) thread_ = std::thread([this] { run(); });
}

Player::~Player() {
    finish();
}

void Player::hear(const frame::Frame& frame) noexcept {
    for (const frame::SoundFrame& sound : frame.task.sounds) {
        const Order order{frame.sequence, sound.sound, sound.on != 0, seconds(frame.time),
                          sink_->clock(frame.time)};
        if (!sink_->mixer().order(order)) lost_.fetch_add(1, std::memory_order_relaxed);
    }
    sink_->pass(frame.time);
    if (!real_) tend();
}

void Player::tend() {
    sink_->tend();
    while (const auto onset = sink_->mixer().take_onset())
        hearings_.add(
            {onset->tick, names_[static_cast<size_t>(onset->sound)], onset->asked, onset->heard});
}

void Player::run() {
    while (!done_.load()) {
        std::this_thread::sleep_for(kTend);
        tend();
        hearings_.flush();
    }
}

std::vector<std::string> Player::finish() {
    if (sink_ == nullptr) return {};
    done_.store(true);
    if (thread_.joinable()) thread_.join();
    tend();
    std::vector<std::string> out = sink_->finish();
    tend();
    if (const int64_t lost = lost_.load() + sink_->mixer().left_out(); lost > 0)
        out.push_back(fmt::format("{} left out: too many sounds would have played at once.",
                                  lost == 1 ? "1 sound was" : fmt::format("{} sounds were", lost)));
    sink_.reset();
    return out;
}

}  // namespace dihaptic::sound
