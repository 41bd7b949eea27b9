#include "sound/wave.h"

#include <fmt/format.h>
#include <samplerate.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/checksum.h"
#include "base/random.h"
#include "base/regular_file.h"
#include "sound/cut_short.h"

namespace dihaptic::sound {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLoop = 10;      // continuous noise and tones repeat with this period [s]
constexpr double kJoin = 0.5;     // time over which pink noise is cross-faded with its start [s]
constexpr double kLowest = 10;    // frequency above which pink noise is pink [Hz]
constexpr double kLongest = 600;  // longest allowed sound file [s]

size_t count(double time, double rate) {
    return static_cast<size_t>(std::llround(time * rate));
}

std::vector<double> tone(const task::SoundSpec& sound, double rate) {
    size_t n = count(sound.duration, rate);
    double frequency = *sound.tone;
    if (sound.goes_on()) {
        const double periods = std::round(kLoop * frequency);
        n = count(periods / frequency, rate);
        frequency = periods * rate / static_cast<double>(n);
    }
    std::vector<double> out(n);
    for (size_t i = 0; i < n; ++i)
        out[i] = std::sin(kTurn * frequency * static_cast<double>(i) / rate);
    return out;
}

std::vector<double> white(size_t n, Random& random) {
    std::vector<double> out(n);
    for (double& sample : out) sample = random.uniform(-1, 1);
    return out;
}

/// Returns a sum of first-order processes of equal power whose corner frequencies are an octave
/// apart. Between the lowest and the highest corner, the power falls as 1/f.
std::vector<double> pink(size_t n, double rate, Random& random) {
    struct Process {
        double keeps;
        double value;
    };
    std::vector<Process> processes;
    for (double corner = kLowest; corner < rate / 2; corner *= 2)
        processes.push_back({std::exp(-kTurn * corner / rate), random.normal()});
    std::vector<double> out(n);
    for (double& sample : out) {
        for (Process& p : processes) {
            p.value = p.keeps * p.value + std::sqrt(1 - p.keeps * p.keeps) * random.normal();
            sample += p.value;
        }
    }
    return out;
}

/// Makes noise repeatable without a click: its last `joint` samples are cross-faded into its start
/// at constant power and then removed.
void join(std::vector<double>& samples, size_t joint) {
    const size_t n = samples.size() - joint;
    for (size_t i = 0; i < joint; ++i) {
        const double part =
            std::numbers::pi / 2 * static_cast<double>(i) / static_cast<double>(joint);
        samples[i] = std::sin(part) * samples[i] + std::cos(part) * samples[n + i];
    }
    samples.resize(n);
}

std::vector<double> noise(const task::SoundSpec& sound, double rate, uint64_t seed) {
    Random random(seed, "sound " + sound.name);
    const size_t n = count(sound.goes_on() ? kLoop : sound.duration, rate);
    if (sound.noise == task::Noise::white) return white(n, random);
    const size_t joint = sound.goes_on() ? count(kJoin, rate) : 0;
    std::vector<double> out = pink(n + joint, rate, random);
    join(out, joint);
    return out;
}

void scale_to_one(std::vector<double>& samples) {
    double largest = 0;
    for (const double sample : samples) largest = std::max(largest, std::abs(sample));
    if (largest == 0) return;
    for (double& sample : samples) sample /= largest;
}

void add_ramps(std::vector<double>& samples, size_t ramp) {
    for (size_t i = 0; i < ramp && i < samples.size(); ++i) {
        const double gain =
            (1 - std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(ramp))) /
            2;
        samples[i] *= gain;
        samples[samples.size() - 1 - i] *= gain;
    }
}

std::vector<float> resampled(const std::vector<float>& samples, double from, double to,
                             const task::SoundSpec& sound) {
    if (from == to || samples.empty()) return samples;
    std::vector<float> out(
        static_cast<size_t>(std::ceil(static_cast<double>(samples.size()) * to / from)));
    SRC_DATA data{};
    data.data_in = samples.data();
    data.data_out = out.data();
    data.input_frames = static_cast<long>(samples.size());
    data.output_frames = static_cast<long>(out.size());
    data.src_ratio = to / from;
    if (const int failed = src_simple(&data, SRC_SINC_BEST_QUALITY, 1); failed != 0)
        throw Error(sound.place, "file",
                    fmt::format("{} cannot be resampled from {:g} to {:g} samples per second: {}",
                                sound.file, from, to, src_strerror(failed)),
                    "Convert it, e.g. with sox.");
    out.resize(static_cast<size_t>(data.output_frames_gen));
    return out;
}

/// Throws Error for a file that was cut short. Otherwise every participant would hear a sound that
/// lasts half as long as intended, or whose end is missing.
void check_whole(const task::SoundSpec& sound, const std::string& fault) {
    if (fault.empty()) return;
    throw Error(sound.place, "file",
                fmt::format("{} was cut short, or made by a program that did not fill in its "
                            "length: it {}",
                            sound.file, fault),
                "Copy it again; if it is complete, rewrite it, e.g. with sox FILE NEW.wav.");
}

std::vector<float> from_file(const task::SoundSpec& sound, double rate) {
    const auto refuse = [&](const std::string& why) {
        throw Error(sound.place, "file", fmt::format("{} {}", sound.file, why),
                    "Give a WAV, FLAC or Ogg file, e.g. made with sox or Audacity.");
    };
    const std::string bytes = read_bytes(sound.file, task::SoundSpec::kLargest);
    if (!sound.checksum.empty() && checksum_of(bytes) != sound.checksum)
        throw Error(sound.place, "file", sound.file + " has changed since it was first read",
                    "Start again once no program is writing to it.");
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(
        sf_open(sound.file.c_str(), SFM_READ, &info), sf_close);
    // the library can open a truncated WAV or FLAC file, but not always a truncated Ogg file
    if (file || bytes.starts_with("OggS")) check_whole(sound, cut_short(bytes));
    if (!file) refuse(fmt::format("is not a sound file: {}", sf_strerror(nullptr)));
    if (info.frames <= 0) refuse("has no samples");
    if (static_cast<double>(info.frames) > kLongest * info.samplerate)
        refuse(fmt::format("is longer than {:g} s", kLongest));
    const auto channels = static_cast<size_t>(info.channels);
    std::vector<float> all(static_cast<size_t>(info.frames) * channels);
    const auto read = static_cast<size_t>(sf_readf_float(file.get(), all.data(), info.frames));
    if (read == 0) refuse(fmt::format("cannot be read: {}", sf_strerror(file.get())));
    if (read < static_cast<size_t>(info.frames))
        check_whole(sound, fmt::format("ends after {} of {} samples", read, info.frames));
    std::vector<float> mean(read);
    for (size_t i = 0; i < read; ++i) {
        for (size_t k = 0; k < channels; ++k)
            mean[i] += all[i * channels + k] / static_cast<float>(channels);
        // a file with floating-point samples may contain any value
        if (!std::isfinite(mean[i])) refuse(fmt::format("has an invalid value for sample {}", i));
    }
    return resampled(mean, info.samplerate, rate, sound);
}

}  // namespace

Wave make_wave(const task::SoundSpec& sound, double rate, uint64_t seed) {
    Wave out{{}, sound.goes_on(), sound.ramp};
    if (!sound.file.empty()) {
        out.samples = from_file(sound, rate);
    } else {
        std::vector<double> samples = sound.tone ? tone(sound, rate) : noise(sound, rate, seed);
        if (sound.noise != task::Noise::no) scale_to_one(samples);
        if (!sound.goes_on()) add_ramps(samples, count(sound.ramp, rate));
        out.samples.assign(samples.begin(), samples.end());
    }
    for (float& sample : out.samples)
        sample = static_cast<float>(std::clamp(sound.level * sample, -1.0, 1.0));
    return out;
}

}  // namespace dihaptic::sound
