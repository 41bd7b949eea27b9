#include "haptics/safety.h"

#include <gtest/gtest.h>

#include <limits>

namespace dihaptic::haptics::safety_test {
namespace {

constexpr double kTick = 1e-3;

/// A handle that moves along x at 1 m/s.
frame::Handle moving(int tick) {
    return {{tick * kTick, 0, 0}, {1, 0, 0}};
}

TEST(HandleGuard, LetsAHandMove) {
    HandleGuard guard(2);
    Fault fault;
    for (int i = 0; i < 100; ++i) {
        const frame::Handle read = moving(i);
        const frame::Handle handle = guard.accept(read, FaultKind::none, i == 0 ? 0 : kTick, fault);
        EXPECT_EQ(handle.p_WH, read.p_WH);
        EXPECT_EQ(handle.v_WH, read.v_WH);
    }
    EXPECT_FALSE(fault);
}

struct Bad {
    const char* name;
    frame::Handle read;
    FaultKind reported;
    FaultKind kind;
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.name;
}
class BadReading : public ::testing::TestWithParam<Bad> {};

TEST_P(BadReading, FaultsAndLeavesTheHandleWhereItWasForGood) {
    HandleGuard guard(2);
    Fault fault;
    for (int i = 0; i < 10; ++i)
        guard.accept(moving(i), FaultKind::none, i == 0 ? 0 : kTick, fault);
    ASSERT_FALSE(fault);
    frame::Handle handle = guard.accept(GetParam().read, GetParam().reported, kTick, fault);
    EXPECT_EQ(fault.kind, GetParam().kind);
    EXPECT_EQ(handle.p_WH, moving(9).p_WH);
    EXPECT_EQ(handle.v_WH, Vec3::Zero());
    Fault again;
    handle = guard.accept(moving(11), FaultKind::none, kTick, again);  // valid again, but too late
    EXPECT_FALSE(again);
    EXPECT_EQ(handle.p_WH, moving(9).p_WH);
    EXPECT_EQ(handle.v_WH, Vec3::Zero());
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
INSTANTIATE_TEST_SUITE_P(
    HandleGuard, BadReading,
    ::testing::Values(
        Bad{"position NaN",
            {{0.01, kNaN, 0}, Vec3::Zero()},
            FaultKind::none,
            FaultKind::bad_reading},
        Bad{"velocity infinite",
            {{0.01, 0, 0}, {0, 0, kInfinite}},
            FaultKind::none,
            FaultKind::bad_reading},
        Bad{"jump of 10 cm", {{0.11, 0, 0}, {1, 0, 0}}, FaultKind::none, FaultKind::too_fast},
        Bad{"too fast", {{0.01, 0, 0}, {0, 2.1, 0}}, FaultKind::none, FaultKind::too_fast},
        Bad{"overflows", {{0.01, 0, 0}, {1e300, 0, 0}}, FaultKind::none, FaultKind::too_fast},
        Bad{"silent",
            {{0.01, 0, 0}, {1, 0, 0}},
            FaultKind::not_answering,
            FaultKind::not_answering},
        Bad{"uncalibrated",
            {{0.01, 0, 0}, {1, 0, 0}},
            FaultKind::uncalibrated,
            FaultKind::uncalibrated},
        Bad{"broken",
            {{0.01, 0, 0}, {1, 0, 0}},
            FaultKind::device_fault,
            FaultKind::device_fault}));

TEST(HandleGuard, AllowsTheDistanceOfTheTimeThatPassed) {
    // pauses are checked elsewhere: after 30 ms at 1 m/s, the handle has moved by 30 mm
    HandleGuard guard(2);
    Fault fault;
    guard.accept(moving(0), FaultKind::none, 0, fault);
    guard.accept(moving(30), FaultKind::none, 30 * kTick, fault);
    EXPECT_FALSE(fault);
}

TEST(FaultLatch, KeepsTheFirst) {
    FaultLatch latch;
    latch.trip({});
    EXPECT_FALSE(latch.tripped());
    latch.trip({FaultKind::too_fast, 1, Time(5), 100, 10});
    latch.trip({FaultKind::not_finite, 0, Time(6)});
    EXPECT_EQ(latch.fault().kind, FaultKind::too_fast);
    EXPECT_EQ(latch.fault().device, 1);
}

TEST(Fault, SaysWhatWhichWhenAndWhatToDo) {
    const Time when = std::chrono::milliseconds(1234);
    EXPECT_EQ(
        describe({FaultKind::too_fast, 1, when, 100, 10}, "index", "Premium 1.0"),
        "force has been off since 1.234 s: the index's device (Premium 1.0) moved at 100 m/s, but "
        "only 10 m/s are allowed. If no hand did that, check its cables and encoders; otherwise "
        "raise settings: safety: max_speed_m_s.");
    EXPECT_EQ(describe({FaultKind::late, -1, when, 0.051, 0.04}, "thumb", "Premium 1.0"),
              "force has been off since 1.234 s: the hands received no new force for 51 ms, but "
              "only 40 ms "
              "are allowed. Close other programs, or look for a device that blocks.");
    EXPECT_EQ(
        describe({FaultKind::stopped, -1, when}, "thumb", "Premium 1.0"),
        "force has been off since 1.234 s: it was stopped by the operator. Everything until then "
        "is recorded.");
    for (const FaultKind kind :
         {FaultKind::bad_reading, FaultKind::not_answering, FaultKind::not_finite}) {
        const std::string text = describe({kind, 0, when}, "thumb", "Premium 1.0");
        EXPECT_NE(text.find("thumb"), std::string::npos) << text;
    }
    // a text that cannot be formatted would throw an exception just when force is switched off
    for (int i = 1; i <= static_cast<int>(FaultKind::stopped); ++i) {
        for (const int device : {-1, 0}) {
            const Fault fault{static_cast<FaultKind>(i), device, when, 2, 1};
            const std::string text = describe(fault, "thumb", "Premium 1.0");
            EXPECT_NE(text.find("1.234 s"), std::string::npos) << text;
            EXPECT_EQ(text.find("  "), std::string::npos) << text;
            EXPECT_TRUE(text.ends_with('.')) << text;
        }
    }
}

}  // namespace
}  // namespace dihaptic::haptics::safety_test
