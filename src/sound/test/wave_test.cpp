// Tests the samples of tones, noise and files against their specifications.
#include "sound/wave.h"

#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "base/regular_file.h"
#include "testing/files.h"

namespace dihaptic::sound::wave_test {
namespace {

constexpr double kRate = 48000;

/// Power at a frequency, computed by the Goertzel algorithm with a Hann window.
double power_at(const std::vector<float>& samples, size_t from, size_t n, double frequency) {
    std::complex<double> sum = 0;
    for (size_t i = 0; i < n; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(n);
        const double window = (1 - std::cos(2 * std::numbers::pi * part)) / 2;
        const double turn = 2 * std::numbers::pi * frequency * static_cast<double>(i) / kRate;
        sum += window * samples[from + i] * std::polar(1.0, -turn);
    }
    return std::norm(sum) / static_cast<double>(n);
}

/// Mean power in the third-octave band around a frequency, in decibels.
double level_around(const std::vector<float>& samples, double frequency) {
    constexpr size_t kWindow = 4800;
    double sum = 0;
    int count = 0;
    for (size_t from = 0; from + kWindow <= samples.size(); from += kWindow) {
        for (double f = frequency * std::exp2(-1.0 / 6); f < frequency * std::exp2(1.0 / 6);
             f += 100) {
            sum += power_at(samples, from, kWindow, f);
            ++count;
        }
    }
    return 10 * std::log10(sum / count);
}

task::SoundSpec tone(double frequency) {
    task::SoundSpec out;
    out.name = "tone";
    out.tone = frequency;
    return out;
}

TEST(Wave, AToneIsASineThatSwellsAndFadesAsARaisedCosine) {
    task::SoundSpec sound = tone(1000);
    sound.level = 0.4;
    const Wave wave = make_wave(sound, kRate, 1);
    ASSERT_EQ(wave.samples.size(), 4800u);
    EXPECT_FALSE(wave.goes_on);
    for (size_t i = 0; i < wave.samples.size(); ++i) {
        const double t = static_cast<double>(i) / kRate;
        const double edge = std::min(t, 0.1 - 1 / kRate - t) / 0.005;
        const double gain = edge < 1 ? (1 - std::cos(std::numbers::pi * edge)) / 2 : 1;
        EXPECT_NEAR(wave.samples[i], 0.4 * gain * std::sin(2000 * std::numbers::pi * t), 1e-6) << i;
    }
}

TEST(Wave, AToneThatGoesOnRepeatsWithoutAStep) {
    for (const double frequency : {20.0, 440.0, 997.3, 12345.6, 19999.0}) {
        task::SoundSpec sound = tone(frequency);
        sound.lasts = task::Lasts::state;
        sound.level = 1;
        const Wave wave = make_wave(sound, kRate, 1);
        EXPECT_TRUE(wave.goes_on);
        const size_t n = wave.samples.size();
        // a sine satisfies x[i+1] + x[i-1] = 2 cos(w) x[i], including where the wave wraps around
        const double c = 2 * std::cos(2 * std::numbers::pi * frequency / kRate);
        for (const size_t i : {n - 2, n - 1, n, n + 1}) {
            EXPECT_NEAR(wave.samples[(i + 1) % n] + wave.samples[(i - 1) % n],
                        c * wave.samples[i % n], 1e-4)
                << frequency;
        }
        const double periods = std::round(frequency * static_cast<double>(n) / kRate);
        EXPECT_NEAR(periods * kRate / static_cast<double>(n) / frequency, 1, kDetuned);
    }
}

task::SoundSpec noise(task::Noise colour, task::Lasts lasts = task::Lasts::once) {
    task::SoundSpec out;
    out.name = "noise";
    out.noise = colour;
    out.lasts = lasts;
    out.duration = 4;
    out.level = 0.7;
    return out;
}

TEST(Wave, WhiteNoiseIsAsStrongAtEachFrequencyAndPinkInEachOctave) {
    const auto white = make_wave(noise(task::Noise::white), kRate, 1).samples;
    const auto pink = make_wave(noise(task::Noise::pink), kRate, 1).samples;
    const double white_at_1k = level_around(white, 1000);
    const double pink_at_1k = level_around(pink, 1000);
    for (const double frequency : {125.0, 250.0, 500.0, 2000.0, 4000.0, 8000.0}) {
        EXPECT_NEAR(level_around(white, frequency) - white_at_1k, 0, 1) << frequency;
        EXPECT_NEAR(level_around(pink, frequency) - pink_at_1k, -10 * std::log10(frequency / 1000),
                    1)
            << frequency;
    }
}

TEST(Wave, TheLoudestSampleOfNoiseIsItsLevelAndTheSeedItsSamples) {
    for (const task::Noise colour : {task::Noise::white, task::Noise::pink}) {
        for (const task::Lasts lasts : {task::Lasts::once, task::Lasts::session}) {
            const auto samples = make_wave(noise(colour, lasts), kRate, 1).samples;
            double largest = 0;
            for (const float sample : samples)
                largest = std::max<double>(largest, std::abs(sample));
            EXPECT_NEAR(largest, 0.7, lasts == task::Lasts::once ? 0.01 : 1e-6);
            EXPECT_EQ(samples, make_wave(noise(colour, lasts), kRate, 1).samples);
            EXPECT_NE(samples, make_wave(noise(colour, lasts), kRate, 2).samples);
        }
    }
}

TEST(Wave, PinkNoiseThatGoesOnHasNoStepAtItsSeam) {
    const auto samples = make_wave(noise(task::Noise::pink, task::Lasts::state), kRate, 3).samples;
    double sum = 0;
    for (size_t i = 1; i < samples.size(); ++i) sum += std::pow(samples[i] - samples[i - 1], 2);
    const double usual = std::sqrt(sum / static_cast<double>(samples.size()));
    EXPECT_LT(std::abs(samples.front() - samples.back()), 4 * usual);
}

/// Writes a file with a sine of 500 Hz in the left channel and silence in the right channel.
std::string write_sine(const testing::TemporaryFolder& folder, int rate) {
    const std::string name = folder.file("sine.wav");
    SF_INFO info{};
    info.samplerate = rate;
    info.channels = 2;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    SNDFILE* const file = sf_open(name.c_str(), SFM_WRITE, &info);
    for (int i = 0; i < rate; ++i) {
        const std::array<float, 2> both{
            static_cast<float>(0.8 * std::sin(1000 * std::numbers::pi * i / rate)), 0.0f};
        sf_writef_float(file, both.data(), 1);
    }
    sf_close(file);
    return name;
}

TEST(Wave, AFileIsTheMeanOfItsChannelsAtTheDevicesRate) {
    for (const int rate : {48000, 44100, 22050}) {
        const testing::TemporaryFolder folder;
        task::SoundSpec sound;
        sound.name = "sine";
        sound.file = write_sine(folder, rate);
        sound.level = 0.5;
        const auto samples = make_wave(sound, kRate, 1).samples;
        ASSERT_NEAR(static_cast<double>(samples.size()), kRate, 2) << rate;
        // the resampling filter rings at both ends of the file
        for (size_t i = 4800; i < 43200; ++i) {
            const double t = static_cast<double>(i) / kRate;
            ASSERT_NEAR(samples[i], 0.2 * std::sin(1000 * std::numbers::pi * t), 1e-4)
                << rate << ", " << i;
        }
    }
}

std::string file_of(const testing::TemporaryFolder& folder, const std::string& name, int format) {
    std::vector<float> samples(48000);
    for (size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<float>(0.4 * std::sin(0.1 * static_cast<double>(i)));
    SF_INFO info{};
    info.samplerate = 48000;
    info.channels = 1;
    info.format = format;
    const std::string file = folder.file(name);
    SNDFILE* const out = sf_open(file.c_str(), SFM_WRITE, &info);
    sf_writef_float(out, samples.data(), static_cast<sf_count_t>(samples.size()));
    sf_close(out);
    return read_bytes(file, 1'000'000);
}

/// Returns the error of make_wave() for a sound file with these bytes; "" if the file is accepted.
std::string refusal_of(const testing::TemporaryFolder& folder, const std::string& bytes) {
    task::SoundSpec sound;
    sound.name = "cut";
    sound.place = {"experiment.yaml", 7};
    sound.file = folder.write("cut", bytes);
    try {
        make_wave(sound, kRate, 1);
    } catch (const Error& e) {
        EXPECT_EQ(e.problems().front().place.line, 7);
        return e.what();
    }
    return "";
}

TEST(Wave, AFileThatWasCutShortIsRefused) {
    const testing::TemporaryFolder folder;
    const std::pair<const char*, int> kinds[] = {
        {"a.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16},
        {"a.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16},
        {"a.ogg", SF_FORMAT_OGG | SF_FORMAT_VORBIS},
        {"a.rf64", SF_FORMAT_RF64 | SF_FORMAT_PCM_16},
    };
    for (const auto& [name, format] : kinds) {
        const std::string whole = file_of(folder, name, format);
        EXPECT_EQ(refusal_of(folder, whole), "") << name;
        for (const double share : {0.5, 0.9, 0.999}) {
            const auto size = static_cast<size_t>(share * static_cast<double>(whole.size()));
            EXPECT_NE(refusal_of(folder, whole.substr(0, size)), "") << name << " " << share;
        }
        EXPECT_NE(refusal_of(folder, whole.substr(0, whole.size() / 2)).find("cut short"),
                  std::string::npos)
            << name << refusal_of(folder, whole.substr(0, whole.size() / 2));
    }
}

TEST(Wave, AWavThatClaimsMoreSamplesThanItHasIsRefused) {
    const testing::TemporaryFolder folder;
    std::string wav = file_of(folder, "a.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16);
    const size_t size = wav.find("data") + 4;
    for (size_t i = 0; i < 4; ++i) wav[size + i] = '\xff';
    EXPECT_NE(refusal_of(folder, wav)
                  .find("has 96000 bytes of samples, but its header states 4294967295"),
              std::string::npos)
        << refusal_of(folder, wav);
}

TEST(Wave, AFileThatIsNoneIsRefusedWithARemedy) {
    const testing::TemporaryFolder folder;
    task::SoundSpec sound;
    sound.name = "words";
    sound.place = {"experiment.yaml", 7};
    for (const char* content : {"", "words", "RIFF\x10\0\0\0WAVE"}) {
        sound.file = folder.write("words.wav", content);
        try {
            make_wave(sound, kRate, 1);
            FAIL() << content;
        } catch (const Error& e) {
            EXPECT_EQ(e.problems().front().place.line, 7);
            EXPECT_NE(std::string(e.what()).find("Give a WAV"), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace dihaptic::sound::wave_test
