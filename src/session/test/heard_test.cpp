// Tests that a session's sounds are heard at the times stated in its tables, and that a session
// runs without sounds if there is no sound device.
#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <cstdlib>

#include "base/table.h"
#include "session/record.h"
#include "session/test/reaches.h"

namespace dihaptic::session::heard_test {
namespace {

constexpr double kRate = 48000;

/// An experiment with reaches that begin with a tone without ramps. Sounds are played into a file.
struct WithTone : Files {
    std::string output;

    explicit WithTone(std::string sound) : output(std::move(sound)) {
        replace("  states:\n", "  sounds: [{ name: go, tone_Hz: 1000, ramp_ms: 0 }]\n  states:\n");
        replace("      marker: 7\n", "      marker: 7\n      sounds: go\n");
        keep_first_block();
    }
    Recorded record_it(Clock clock, std::vector<std::string>* warnings = nullptr) {
        Request made = request();
        made.rig = folder.write(
            "rig.yaml",
            "devices: [{ finger: index, backend: simulated }]\nsound: " + output + "\n");
        RunOptions options;
        options.clock = clock;
        options.out = folder.file("sessions");
        options.warn = [&](const std::string& message) {
            if (warnings != nullptr) warnings->push_back(message);
        };
        return record(make_plan(made), options, kGoOn);
    }
};

/// Returns the times at which sound begins after silence in a file [s].
std::vector<double> onsets_in(const std::string& name) {
    SF_INFO info{};
    SNDFILE* const file = sf_open(name.c_str(), SFM_READ, &info);
    EXPECT_NE(file, nullptr) << name;
    if (file == nullptr) return {};
    EXPECT_EQ(info.samplerate, kRate);
    EXPECT_EQ(info.channels, 1);
    std::vector<float> samples(static_cast<size_t>(info.frames));
    sf_readf_float(file, samples.data(), info.frames);
    sf_close(file);
    std::vector<double> out;
    size_t silent = kRate;  // samples
    for (size_t i = 0; i < samples.size(); ++i) {
        // a sine starts with a zero sample
        if (samples[i] != 0 && silent > 1000) out.push_back(static_cast<double>(i - 1) / kRate);
        silent = samples[i] != 0 ? 0 : silent + 1;
    }
    return out;
}

void expect_heard(const Recorded& session, double delay) {
    EXPECT_TRUE(session.good());
    const std::vector<double> onsets = onsets_in(session.folder + "/sound.wav");
    ASSERT_EQ(onsets.size(), 2u);
    const CsvFile heard(session.folder + "/heard.csv");
    ASSERT_EQ(heard.rows(), 2u);
    const CsvFile events(session.folder + "/events.csv");
    size_t found = 0;
    for (size_t i = 0; i < events.rows(); ++i) {
        if (events.text(i, "event") != "sound") continue;
        ASSERT_LT(found, 2u);
        EXPECT_EQ(events.text(i, "detail"), "go");
        EXPECT_NEAR(events.number(i, "heard_s"), onsets[found], 1 / kRate);
        EXPECT_NEAR(events.number(i, "heard_s") - events.number(i, "time_s"), delay, 1 / kRate);
        EXPECT_EQ(heard.text(found, "sound"), "go");
        EXPECT_NEAR(heard.number(found, "asked_s"), events.number(i, "time_s"), 1e-6);
        ++found;
    }
    EXPECT_EQ(found, 2u);
}

TEST(Heard, ASoundInTheFileBeginsWhereTheTablesSay) {
    expect_heard(WithTone("{ to: file }").record_it(Clock::virtual_clock), 0);
    expect_heard(WithTone("{ to: file, delay_ms: 12.5 }").record_it(Clock::virtual_clock), 0.0125);
    expect_heard(WithTone("{ to: file, delay_ms: 12.5 }").record_it(Clock::real), 0.0125);
}

TEST(Heard, ASessionRunsWithoutItsSoundsWhereThereIsNoDevice) {
    std::vector<std::string> warnings;
    WithTone files("{ device: no such device }");
    const Recorded session = files.record_it(Clock::real, &warnings);
    EXPECT_TRUE(session.good());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("The sounds are not played"), std::string::npos) << warnings[0];
    EXPECT_NE(std::find(session.info.notes.begin(), session.info.notes.end(), warnings[0]),
              session.info.notes.end());
    const CsvFile events(session.folder + "/events.csv");
    int asked = 0;
    for (size_t i = 0; i < events.rows(); ++i) {
        if (events.text(i, "event") != "sound") continue;
        ++asked;
        EXPECT_TRUE(std::isnan(events.number(i, "heard_s")));
    }
    EXPECT_EQ(asked, 2);
}

TEST(Heard, ARehearsalIsSilentUnlessItsSoundsGoToAFile) {
    WithTone files("{ to: speakers }");
    const Recorded session = files.record_it(Clock::virtual_clock);
    EXPECT_TRUE(session.good());
    EXPECT_TRUE(session.info.notes.empty());
    EXPECT_FALSE(std::filesystem::exists(session.folder + "/heard.csv"));
}

TEST(Heard, ASoundFileIsFrozenWithTheSessionAndPlayedFromThere) {
    WithTone files("{ to: file }");
    SF_INFO info{};
    info.samplerate = 48000;
    info.channels = 1;
    info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
    SNDFILE* const file = sf_open(files.folder.file("click.wav").c_str(), SFM_WRITE, &info);
    const std::vector<float> click{0.0f, 0.9f, -0.9f, 0.9f};
    sf_writef_float(file, click.data(), static_cast<sf_count_t>(click.size()));
    sf_close(file);
    files.replace("tone_Hz: 1000, ramp_ms: 0", "file: click.wav");
    const Recorded session = files.record_it(Clock::virtual_clock);
    expect_heard(session, 0);
    EXPECT_TRUE(std::filesystem::exists(session.folder + "/sound-1-click.wav"));
    EXPECT_NE(testing::read_file(session.folder + "/task.yaml").find("file: sound-1-click.wav"),
              std::string::npos);
}

}  // namespace
}  // namespace dihaptic::session::heard_test
