#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <portaudio.h>

#include <array>
#include <chrono>

#include "base/plural.h"
#include "sound/player.h"
#include "sound/sink.h"
#include "sound/stream_clock.h"

namespace dihaptic::sound {
namespace {

constexpr unsigned long kBuffer = 128;  // number of samples requested at a time
constexpr int kChannels = 2;

/// A snd_lib_error_handler_t.
void say_nothing(const char*, int, const char*, int, const char*, ...) {}

/// Prevents ALSA and JACK from writing a message to the terminal for each device that they fail to
/// open.
void silence_systems() {
    const auto set = [](const char* setter, auto* handler) {
        using Set = void (*)(decltype(handler));
        if (const auto found = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, setter))) found(handler);
    };
    set("snd_lib_error_set_handler", &say_nothing);
    set(
        "jack_set_error_function", +[](const char*) {});
    set(
        "jack_set_info_function", +[](const char*) {});
}

/// Initialises PortAudio, and terminates it when it is no longer needed.
class System {
  public:
    System() {
        silence_systems();
        if (const PaError failed = Pa_Initialize(); failed != paNoError)
            throw Error(
                fmt::format("The sound system cannot be started: {}.", Pa_GetErrorText(failed)),
                "Check it with speaker-test.");
    }
    ~System() { Pa_Terminate(); }
    System(const System&) = delete;
    System& operator=(const System&) = delete;
};

/// Returns the index of the first output device whose name contains the requested text or, if the
/// text is empty, of the default device.
PaDeviceIndex find_device(const display::SoundOutput& output) {
    std::vector<std::string> names;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(i);
        if (info.maxOutputChannels < 1) continue;
        names.emplace_back(info.name);
        if (!output.device.empty() && names.back().find(output.device) != std::string::npos)
            return i;
    }
    if (names.empty())
        throw Error(output.place, "device", "there is no sound device",
                    "Plug one in; 'aplay -l' lists the system's devices.");
    if (!output.device.empty())
        throw Error(output.place, "device", fmt::format("there is no '{}'", output.device),
                    fmt::format("Available devices: {}.", fmt::join(names, "; ")));
    return Pa_GetDefaultOutputDevice();
}

int64_t steady_now() noexcept {
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

class Speakers final : public Sink {
  public:
    Speakers(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
             const display::SoundOutput& output)
        : clock_(output.rate), mono_(kMostSamples) {
        const PaDeviceIndex device = find_device(output);
        const PaDeviceInfo* const info = Pa_GetDeviceInfo(device);
        name_ = info == nullptr ? "the sound device" : info->name;
        PaStreamParameters parameters{};
        parameters.device = device;
        parameters.channelCount =
            info == nullptr ? kChannels : std::min(kChannels, info->maxOutputChannels);
        parameters.sampleFormat = paFloat32;
        parameters.suggestedLatency = info == nullptr ? 0.02 : info->defaultLowOutputLatency;
        channels_ = static_cast<size_t>(parameters.channelCount);
        check(Pa_OpenStream(&stream_, nullptr, &parameters, output.rate, kBuffer, paNoFlag, call,
                            this),
              name_, output);
        const double needed = Pa_GetStreamInfo(stream_)->outputLatency + 2 * kBuffer / output.rate;
        mixer_.emplace(make_waves(sounds, seed, output.rate), output.rate,
                       output.delay.value_or(needed));
        if (const PaError failed = Pa_StartStream(stream_); failed != paNoError) {
            Pa_CloseStream(stream_);
            check(failed, name_, output);
        }
    }
    ~Speakers() override { close(); }
    Speakers(const Speakers&) = delete;
    Speakers& operator=(const Speakers&) = delete;

    const std::string& name() const { return name_; }
    Mixer& mixer() noexcept override { return *mixer_; }
    int64_t clock(Time) const noexcept override { return steady_now(); }
    std::vector<std::string> finish() override {
        close();
        std::vector<std::string> out;
        if (const int64_t broken = broken_.load(); broken > 0)
            out.push_back(
                fmt::format("The sound was interrupted {}: the computer could not keep up. Onsets "
                            "in heard.csv may be wrong at those times.",
                            counted(broken, "time")));
        return out;
    }

  private:
    static constexpr size_t kMostSamples = 8192;

    static void check(PaError failed, const std::string& name, const display::SoundOutput& output) {
        if (failed == paNoError) return;
        throw Error(output.place, "device",
                    fmt::format("{} cannot be opened: {}", name, Pa_GetErrorText(failed)),
                    "Close other programs that play sound, or choose another device or rate_Hz "
                    "under 'sound' in the rig.");
    }
    static int call(const void*, void* out, unsigned long samples,
                    const PaStreamCallbackTimeInfo* time, PaStreamCallbackFlags flags,
                    void* self) noexcept {
        static_cast<Speakers*>(self)->fill(static_cast<float*>(out), samples, *time, flags);
        return paContinue;
    }
    void fill(float* out, size_t samples, const PaStreamCallbackTimeInfo& time,
              PaStreamCallbackFlags flags) noexcept {
        // the first buffers are all requested at once
        if ((flags & paOutputUnderflow) != 0 && (flags & paPrimingOutput) == 0) {
            broken_.fetch_add(1, std::memory_order_relaxed);
            clock_.begin_anew();
        }
        const double ahead = time.outputBufferDacTime - time.currentTime;
        int64_t said = steady_now() + static_cast<int64_t>(ahead * 1e9);
        while (samples > 0) {
            const size_t n = std::min(samples, kMostSamples);
            const std::span<float> mono(mono_.data(), n);
            mixer_->render(mono, clock_.next(said, n));
            for (const float sample : mono) {
                for (size_t k = 0; k < channels_; ++k) *out++ = sample;
            }
            said += static_cast<int64_t>(static_cast<double>(n) / mixer_->rate() * 1e9);
            samples -= n;
        }
    }
    void close() noexcept {
        if (stream_ == nullptr) return;
        Pa_StopStream(stream_);  // returns once the buffered samples have been heard
        Pa_CloseStream(stream_);
        stream_ = nullptr;
    }

    System system_;
    std::string name_;
    StreamClock clock_;
    std::vector<float> mono_;
    size_t channels_ = kChannels;
    PaStream* stream_ = nullptr;
    std::optional<Mixer> mixer_;
    std::atomic<int64_t> broken_{0};
};

}  // namespace

std::unique_ptr<Sink> open_speakers(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                    const display::SoundOutput& output) {
    return std::make_unique<Speakers>(sounds, seed, output);
}

std::string try_speakers(const display::SoundOutput& output) {
    return Speakers({}, 0, output).name();
}

}  // namespace dihaptic::sound
