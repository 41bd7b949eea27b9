// Tests that every kind of outlet keeps the contract of outlet.h: a failure is reported and does
// not delay anything.
#include <gtest/gtest.h>

#include <array>

#include "fallible.h"
#include "outlets/station.h"

namespace dihaptic::outlets::conformance_test {
namespace {

const About kAbout{"2026-01-01_lift", 1000, {{"thumb_x", "m"}}};

class Conformance : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        fallible = make_fallible(GetParam());
        ASSERT_NE(fallible, nullptr) << "fallible.h does not say how this kind fails";
    }
    OutletConfig config() const {
        return {GetParam(), parse_yaml(fallible->options(), "rig.yaml"), {"rig.yaml", 7}};
    }
    std::unique_ptr<Fallible> fallible;
};

TEST_P(Conformance, OneThatWorksHasNothingToTell) {
    Station station({config()}, kAbout);
    for (int i = 0; i < 20; ++i) station.send(i % 2, std::array{1.0f});
    EXPECT_TRUE(station.finish().empty());
}

TEST_P(Conformance, OneThatCannotBeOpenedIsRefusedWithItsPlaceAndARemedy) {
    fallible->never_open();
    try {
        const Station station({config()}, kAbout);
        FAIL();
    } catch (const Error& e) {
        ASSERT_EQ(e.problems().size(), 1u);
        EXPECT_EQ(e.problems()[0].place.line, 7);
        EXPECT_NE(e.problems()[0].key, "");
        EXPECT_NE(e.problems()[0].remedy, "");
    }
}

TEST_P(Conformance, OneThatFailsIsToldOnceAndHoldsNothingUp) {
    Station station({config()}, kAbout);
    station.send(1, std::array{1.0f});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // time for the code to arrive
    fallible->fail();
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < 100; ++i) station.send(2, std::array{1.0f});
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(1));
    const std::vector<std::string> told = station.finish();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].find(GetParam() + ": "), 0u) << told[0];
    EXPECT_NE(told[0].find("events.csv"), std::string::npos) << told[0];
}

TEST_P(Conformance, OneThatFailsLeavesTheOthersGoing) {
    const testing::FarEnd other;
    Station station(
        {config(), {"serial", parse_yaml("{ port: " + other.port + " }", "rig.yaml"), {}}}, kAbout);
    fallible->fail();
    station.send(3, std::array{1.0f});
    station.send(4, std::array{1.0f});
    EXPECT_EQ(other.receive(2), (std::vector<int>{3, 4}));
    EXPECT_EQ(station.finish().size(), 1u);
}

std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const Kind& kind : kinds()) out.emplace_back(kind.name);
    return out;
}
INSTANTIATE_TEST_SUITE_P(Kinds, Conformance, ::testing::ValuesIn(names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace dihaptic::outlets::conformance_test
