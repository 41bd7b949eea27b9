#include <fmt/format.h>
#include <sndfile.h>

#include <cmath>

#include "sound/sink.h"

namespace dihaptic::sound {
namespace {

class SoundFile final : public Sink {
  public:
    SoundFile(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
              const display::SoundOutput& output, const std::string& file)
        : mixer_(make_waves(sounds, seed, output.rate), output.rate, output.delay.value_or(0)),
          file_(nullptr, sf_close),
          name_(file),
          block_(kBlock) {
        SF_INFO info{};
        info.samplerate = static_cast<int>(std::lround(output.rate));
        info.channels = 1;
        info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
        file_.reset(sf_open(file.c_str(), SFM_WRITE, &info));
        if (!file_)
            throw Error(output.place, "to",
                        fmt::format("{} cannot be written: {}", file, sf_strerror(nullptr)),
                        "Free space on the disk.");
    }

    Mixer& mixer() noexcept override { return mixer_; }
    int64_t clock(Time session) const noexcept override { return session.count(); }
    void pass(Time session) noexcept override {
        passed_.store(session.count(), std::memory_order_release);
    }
    void tend() override { write_to(passed_.load(std::memory_order_acquire), kBlock); }
    std::vector<std::string> finish() override {
        write_to(passed_.load(std::memory_order_acquire), 1);
        file_.reset();
        if (failed_.empty()) return {};
        return {fmt::format("{} ends too soon: {}.", name_, failed_)};
    }

  private:
    static constexpr size_t kBlock = 1024;  // samples

    /// Writes samples until the stream reaches `time`, in blocks of at least `least` samples.
    void write_to(int64_t time, size_t least) {
        const auto until = static_cast<int64_t>(static_cast<double>(time) * 1e-9 * mixer_.rate());
        while (failed_.empty() && until - written_ >= static_cast<int64_t>(least)) {
            const auto n = std::min<int64_t>(until - written_, kBlock);
            const std::span<float> out(block_.data(), static_cast<size_t>(n));
            mixer_.render(out, std::llround(static_cast<double>(written_) / mixer_.rate() * 1e9));
            if (sf_writef_float(file_.get(), out.data(), n) != n)
                failed_ = sf_strerror(file_.get());
            written_ += n;
        }
    }

    Mixer mixer_;
    std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file_;
    std::string name_;
    std::vector<float> block_;
    std::string failed_;
    int64_t written_ = 0;  // samples
    std::atomic<int64_t> passed_{0};
};

}  // namespace

std::unique_ptr<Sink> open_file(const std::vector<task::SoundSpec>& sounds, uint64_t seed,
                                const display::SoundOutput& output, const std::string& file) {
    return std::make_unique<SoundFile>(sounds, seed, output, file);
}

}  // namespace dihaptic::sound
