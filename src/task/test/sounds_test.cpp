// Tests the sounds of a task: the ticks in which they begin and end, and the error message for
// every mistake in their keys.
#include <gtest/gtest.h>

#include <set>

#include "base/number.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/allocations.h"
#include "session/test/reaches.h"

namespace dihaptic::task::sounds_test {
namespace {

using session::Mistake;

const char* const kSounds = R"(  sounds:
    - { name: go, tone_Hz: 1000, duration_ms: 50 }
    - { name: good, tone_Hz: 1500 }
    - { name: hum, noise: pink, lasts: state }
    - { name: wind, noise: white, level: 0.02, lasts: session }
  states:
)";

/// Reaches that begin with one tone and end with another, with a hum from the beginning to the end
/// of the trial, and the sound of wind throughout the session.
struct WithSounds : session::Files {
    WithSounds() {
        replace("  states:\n", kSounds);
        replace("      message: Go home\n", "      message: Go home\n      sounds: hum\n");
        replace("      marker: 7\n", "      marker: 7\n      sounds: [hum, go]\n");
        replace("feedback: Good }", "feedback: Good, sound: good }");
        keep_first_block();
    }
};

constexpr int kGo = 0, kGood = 1, kHum = 2, kWind = 3;

TEST(Sounds, BeginInTheTickInWhichTheirStateBeginsOrTheirExitIsTaken) {
    WithSounds files;
    const session::RunResult result = files.run(session::make_plan(files.request()));
    recording::RawLogReader log(result.folder + "/raw.log");
    EXPECT_EQ(log.head().sounds, (std::vector<std::string>{"go", "good", "hum", "wind"}));
    int phase = 0;
    std::vector<int> begun(4), ended(4);
    while (const frame::Frame* frame = log.next()) {
        std::set<std::pair<int, int>> wanted;
        if (frame->sequence == 0) wanted.insert({kWind, 1});
        if (frame->phase == 1 && phase != 1) wanted.insert({kHum, 1});
        if (frame->phase == 2 && phase != 2) wanted.insert({kGo, 1});
        // the last tick of the trial still belongs to its last state
        if (frame->task.outcome >= 0) wanted.insert({{kGood, 1}, {kHum, 0}});
        std::set<std::pair<int, int>> found;
        for (const frame::SoundFrame& sound : frame->task.sounds) {
            found.insert({sound.sound, static_cast<int>(sound.on)});
            ++(sound.on != 0 ? begun : ended)[static_cast<size_t>(sound.sound)];
        }
        EXPECT_EQ(found, wanted) << "in tick " << frame->sequence;
        phase = frame->phase;
    }
    EXPECT_EQ(begun, (std::vector<int>{2, 2, 2, 1}));
    EXPECT_EQ(ended, (std::vector<int>{0, 0, 2, 0}));
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Sounds, AllocateNothingInTheTick) {
    WithSounds files;
    session::expect_no_allocation(session::make_plan(files.request()), 20);
}

class BrokenSound : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenSound, IsRefusedWithFileLineAndRemedy) {
    WithSounds files;
    files.folder.write("words.wav", "words");
    session::expect_refused(files, GetParam());
}

const char* const kTone = "tone_Hz: 1000, duration_ms: 50";
const char* const kEnd = "sound: good";

INSTANTIATE_TEST_SUITE_P(
    Sounds, BrokenSound,
    ::testing::Values(Mistake{kTone, "duration_ms: 50", "go: has no sound"},
                      Mistake{kTone, "tone_Hz: 1000, noise: pink", "gives several sounds at once"},
                      Mistake{kTone, "tone_Hz: 5", "must be"},
                      Mistake{kTone, "tone_ms: 5", "tone_ms"},
                      Mistake{kTone, "tone_Hz: 1000, duration_ms: 50, ramp_ms: 30",
                              "longer than the duration of 'go'"},
                      Mistake{kTone, "tone_Hz: 1000, level: 2", "must be"},
                      Mistake{kTone, "tone_Hz: 1000, lasts: ever", "'ever' is not known"},
                      Mistake{kTone, "noise: brown", "'brown' is not known"},
                      Mistake{kTone, "file: none.wav", "there is no file"},
                      Mistake{kTone, "file: words.wav", "is not a sound file"},
                      Mistake{"name: good,", "name: go,", "'go'"},
                      Mistake{"sounds: hum", "sounds: ham", "Did you mean hum?"},
                      Mistake{"sounds: hum", "sounds: [wind]", "lasts throughout the session"},
                      Mistake{kEnd, "sound: goodd", "Did you mean good?"},
                      Mistake{kEnd, "sound: hum", "an exit has no duration"},
                      Mistake{kEnd, "sound: wind", "lasts throughout the session"}));

TEST(Sounds, AreAtMostAsManyAsATickCanBegin) {
    WithSounds files;
    std::string many = "  sounds:\n";
    for (int i = 0; i < 30; ++i) many += "    - { name: s" + number_text(i) + ", tone_Hz: 440 }\n";
    session::expect_refused(files, Mistake{"  sounds:\n", many.c_str(), "at most 32 are allowed"});
}

}  // namespace
}  // namespace dihaptic::task::sounds_test
