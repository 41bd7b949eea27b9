#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/number.h"
#include "base/temporary_folder.h"
#include "fake_lsl.h"
#include "outlets/station.h"
#include "testing/allocation_guard.h"
#include "testing/far_end.h"

namespace dihaptic::outlets::outlets_test {
namespace {

using testing::FarEnd;

OutletConfig config(const std::string& kind, const std::string& options) {
    return {kind, parse_yaml(options, "rig.yaml"), {"rig.yaml", 7}};
}

TEST(Serial, SendsEachCodeAndThenZeroWhereAPulseIsAskedFor) {
    const FarEnd far;
    Station station({config("serial", "{ port: " + far.port + ", hold_ms: 3 }")}, {});
    EXPECT_FALSE(station.wants_samples());
    station.send(17, {});
    EXPECT_EQ(far.receive(2), (std::vector<int>{17, 0}));
    station.send(255, {});
    station.send(0, {});  // a tick without a code
    EXPECT_EQ(far.receive(2), (std::vector<int>{255, 0}));
    EXPECT_TRUE(station.finish().empty());
}

TEST(Serial, CodesThatAreLeftAreSentAtTheEnd) {
    const FarEnd far;
    Station station({config("serial", "{ port: " + far.port + " }")}, {});
    for (int code = 1; code <= 200; ++code) station.send(code, {});
    EXPECT_TRUE(station.finish().empty());
    const std::vector<int> received = far.receive(200);
    ASSERT_EQ(received.size(), 200u);
    for (int i = 0; i < 200; ++i) EXPECT_EQ(received[static_cast<size_t>(i)], i + 1);
}

TEST(Serial, WhatComesInIsATrigger) {
    const FarEnd far;
    Station station({config("serial", "{ port: " + far.port + " }")}, {});
    EXPECT_EQ(station.take_trigger(), 0);
    far.send(5);
    int code = 0;
    for (int i = 0; i < 2000 && code == 0; ++i) {
        code = station.take_trigger();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(code, 5);
    EXPECT_EQ(station.take_trigger(), 0);  // each trigger is returned only once
}

TEST(Serial, ALineThatIsPulledIsToldThoughNothingIsSentOnIt) {
    auto far = std::make_unique<FarEnd>();
    Station station({config("serial", "{ port: " + far->port + " }")}, {});
    far.reset();  // no further trigger can arrive
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::vector<std::string> failures = station.finish();
    ASSERT_EQ(failures.size(), 1u);
    EXPECT_NE(failures[0].find("cannot be read"), std::string::npos) << failures[0];
}

TEST(Serial, APortThatIsNotThereIsRefusedWithARemedy) {
    try {
        Station station({config("serial", "{ port: /dev/no-such-line }")}, {});
        FAIL();
    } catch (const Error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("rig.yaml:7"), std::string::npos) << text;
        EXPECT_NE(text.find("No such file"), std::string::npos) << text;
        EXPECT_NE(text.find("ls /dev/tty"), std::string::npos) << text;
    }
}

TEST(Serial, AFileIsNoLine) {
    const TemporaryFolder folder;
    const std::string file = folder.path() + "/file";
    std::ofstream(file) << "x";
    EXPECT_THROW(Station({config("serial", "{ port: " + file + " }")}, {}), Error);
}

struct Records {
    TemporaryFolder folder;
    std::string file = folder.path() + "/lsl.txt";
    Records() { setenv("DIHAPTIC_FAKE_LSL", file.c_str(), 1); }
    std::vector<std::vector<std::string>> read(const std::string& kind) const {
        std::vector<std::vector<std::string>> out;
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);) {
            std::vector<std::string> cells;
            std::istringstream text(line);
            for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
            if (cells[0] == kind) out.push_back(cells);
        }
        return out;
    }
};

TEST(Lsl, StreamsCodesAndValuesWithTheTimesOfTheirTicks) {
    const Records records;
    const About about{"2026-01-01_lift", 1000, {{"thumb_x", "m"}, {"thumb_force_x", "N"}}};
    Station station(
        {config("lsl", std::string("{ name: Lab, library: ") + DIHAPTIC_FAKE_LSL + " }")}, about);
    EXPECT_TRUE(station.wants_samples());
    const auto clock = [] {
        return 1000 + std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    };
    const double before = clock();
    station.send(0, std::array{0.25f, 1.5f});
    station.send(42, std::array{0.5f, -2.0f});
    const double after = clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // sent only after `after`
    EXPECT_TRUE(station.finish().empty());

    const auto infos = records.read("info");
    ASSERT_EQ(infos.size(), 2u);
    EXPECT_EQ(infos[0], (std::vector<std::string>{"info", "Lab markers", "Markers", "1", "0", "3",
                                                  "2026-01-01_lift/markers"}));
    EXPECT_EQ(infos[1], (std::vector<std::string>{"info", "Lab handles", "Haptics", "2", "1000",
                                                  "1", "2026-01-01_lift/handles"}));
    const auto values = records.read("value");
    ASSERT_EQ(values.size(), 6u);
    EXPECT_EQ(values[4][2], "thumb_force_x");
    EXPECT_EQ(values[5][2], "N");
    const auto samples = records.read("sample");
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[0][3], "0.25");
    EXPECT_EQ(samples[1][4], "-2");
    const auto marks = records.read("mark");
    ASSERT_EQ(marks.size(), 1u);
    EXPECT_EQ(marks[0][3], "42");
    EXPECT_GE(finite_number(marks[0][2]).value(), before - 1e-3);
    EXPECT_LE(finite_number(marks[0][2]).value(), after + 1e-3);
}

TEST(Lsl, OneStreamThatFailsIsEnough) {
    const Records records;
    Station station({config("lsl", std::string("{ library: ") + DIHAPTIC_FAKE_LSL + " }")},
                    {"s", 1000, {{"x", "m"}}});
    fake_lsl_fails(FakeLslFails::codes_only);
    station.send(0, std::array{1.0f});
    station.send(5, std::array{2.0f});
    const std::vector<std::string> failures = station.finish();
    fake_lsl_fails(FakeLslFails::nothing);
    ASSERT_EQ(failures.size(), 1u);
    EXPECT_NE(failures[0].find("did not accept a code: the stream was lost (-2)"),
              std::string::npos)
        << failures[0];
    EXPECT_EQ(records.read("sample").size(), 1u);
}

TEST(Lsl, AStreamThatItCannotDescribeIsRefused) {
    const Records records;
    fake_lsl_fails(FakeLslFails::describing);
    EXPECT_THROW(Station({config("lsl", std::string("{ library: ") + DIHAPTIC_FAKE_LSL + " }")},
                         {"s", 1000, {{"x", "m"}}}),
                 Error);
    fake_lsl_fails(FakeLslFails::nothing);
}

TEST(Lsl, WithoutTheLibraryItSaysWhatWasSoughtAndWhereToGetIt) {
    try {
        Station station({config("lsl", "{ library: /no/such/liblsl.so }")}, {});
        FAIL();
    } catch (const Error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("/no/such/liblsl.so"), std::string::npos) << text;
        EXPECT_NE(text.find("github.com/sccn/liblsl"), std::string::npos) << text;
    }
}

TEST(Lsl, ALibraryThatIsAnotherOneIsRefused) {
    try {
        Station station({config("lsl", "{ library: libm.so.6 }")}, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("has no lsl_create_streaminfo"), std::string::npos)
            << e.what();
    }
}

TEST(Station, SendsWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const FarEnd far;
    Station station({config("serial", "{ port: " + far.port + " }")}, {"s", 1000, {{"x", "m"}}});
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        station.send(i % 2, std::array{1.0f});
        (void)station.take_trigger();
    }
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Kinds, RefuseWhatTheyDoNotKnow) {
    const auto problems = [](const OutletConfig& outlet) {
        Diagnostics diagnostics;
        check({outlet}, diagnostics);
        return diagnostics.problems();
    };
    EXPECT_TRUE(problems(config("serial", "{ port: /dev/ttyUSB0 }")).empty());
    EXPECT_TRUE(problems({"lsl", {}, {}}).empty());
    EXPECT_EQ(problems(config("parallel", "{ port: 1 }")).size(), 1u);
    EXPECT_EQ(problems({"serial", {}, {}}).size(), 1u);
    EXPECT_EQ(problems(config("serial", "{ port: /dev/ttyUSB0, baud: 12 }")).size(), 1u);
    EXPECT_EQ(problems(config("serial", "{ port: /dev/ttyUSB0, hold_ms: 5000 }")).size(), 1u);
    EXPECT_EQ(problems(config("lsl", "{ nmae: Lab }")).size(), 1u);
}

}  // namespace
}  // namespace dihaptic::outlets::outlets_test
