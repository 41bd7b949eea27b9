#include "sound/mixer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dihaptic::sound {
namespace {

/// Value at sample `i` of a raised cosine that rises from 0 to 1 over `ramp` samples.
double swell(int64_t i, int64_t ramp) noexcept {
    if (i >= ramp) return 1;
    return (1 - std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(ramp))) /
           2;
}

}  // namespace

Mixer::Mixer(std::vector<Wave> waves, double rate, double delay)
    : waves_(std::move(waves)), rate_(rate), delay_(std::llround(delay * 1e9)) {
    // pushing and popping one request allocates the memory for all later ones
    orders_.push({});
    orders_.pop();
}

int64_t Mixer::samples_until(int64_t at, int64_t first) const noexcept {
    const double until = static_cast<double>(at + delay_ - first) * 1e-9;
    return std::max<int64_t>(0, std::llround(until * rate_));
}

void Mixer::begin(const Order& order, int64_t first) noexcept {
    const auto free = std::find_if(voices_.begin(), voices_.end(),
                                   [](const Voice& voice) { return voice.sound < 0; });
    if (free == voices_.end() || waves_[static_cast<size_t>(order.sound)].samples.empty()) {
        left_out_.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    *free = Voice{order.sound, samples_until(order.at, first)};
    const double heard =
        static_cast<double>(first - order.at) * 1e-9 + static_cast<double>(free->wait) / rate_;
    onsets_.push({order.tick, order.sound, order.asked, order.asked + heard});
}

void Mixer::take(const Order& order, int64_t first) noexcept {
    if (order.begins) {
        begin(order, first);
        return;
    }
    for (Voice& voice : voices_) {
        if (voice.sound == order.sound && voice.ends < 0)
            voice.ends = samples_until(order.at, first);
    }
}

void Mixer::mix(Voice& voice, std::span<float> out) noexcept {
    const Wave& wave = waves_[static_cast<size_t>(voice.sound)];
    const int64_t ramp = wave.goes_on ? std::llround(wave.ramp * rate_) : 0;
    for (float& sample : out) {
        const bool fades = voice.ends == 0;
        if (voice.ends > 0) --voice.ends;
        if (voice.wait > 0) {
            --voice.wait;
            continue;
        }
        if (fades && voice.faded >= ramp) {
            voice.sound = -1;
            return;
        }
        const double gain =
            swell(voice.age++, ramp) * (fades ? 1 - swell(voice.faded++, ramp) : 1.0);
        sample += static_cast<float>(gain) * wave.samples[voice.at];
        if (++voice.at < wave.samples.size()) continue;
        voice.at = 0;
        if (wave.goes_on) continue;
        voice.sound = -1;
        return;
    }
}

void Mixer::render(std::span<float> out, int64_t first) noexcept {
    while (const auto order = orders_.pop()) take(*order, first);
    std::fill(out.begin(), out.end(), 0.0f);
    for (Voice& voice : voices_) {
        if (voice.sound >= 0) mix(voice, out);
    }
    for (float& sample : out) sample = std::clamp(sample, -1.0f, 1.0f);
}

}  // namespace dihaptic::sound
