// Tests that written numbers are read back unchanged, and that other words are not taken for
// numbers.
#include "base/number.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

namespace dihaptic::number_test {
namespace {

TEST(Number, IsTheSameWhenItIsReadAgain) {
    std::mt19937_64 random(20261127);
    int finite = 0;
    for (int i = 0; i < 100'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        ++finite;
        const auto again = finite_number(number_text(value));
        ASSERT_TRUE(again.has_value()) << number_text(value);
        ASSERT_EQ(std::bit_cast<uint64_t>(*again), std::bit_cast<uint64_t>(value));
        ASSERT_EQ(number_text(value).find(','), std::string::npos);
    }
    EXPECT_GT(finite, 90'000);
    EXPECT_EQ(number_text(0.1 + 0.2, 9), "0.3");
    EXPECT_EQ(number_text(uint64_t{18446744073709551615U}), "18446744073709551615");
}

TEST(Number, IsNoWordThatOnlyBeginsWithOne) {
    for (const char* word : {"", " ", "0,5", "1.5 ", " 1.5", "1.5x", "+-1", "--1", "0x1F", "1_000",
                             "1e", "nan", "inf", "1e400"})
        EXPECT_FALSE(finite_number(word).has_value()) << word;
    for (const auto& [word, value] :
         {std::pair{"+1e3", 1000.0}, {"-0.5", -0.5}, {".5", 0.5}, {"5.", 5.0}, {"010", 10.0}})
        EXPECT_EQ(finite_number(word), value) << word;
    EXPECT_EQ(any_number("-inf"), -std::numeric_limits<double>::infinity());
    EXPECT_FALSE(any_number("nan").has_value());
    EXPECT_EQ(whole_number<int>("-7"), -7);
    EXPECT_EQ(whole_number<int>("040", 8), 32);
    for (const char* word : {"", "7.0", "7 ", "2147483648", "+7"})
        EXPECT_FALSE(whole_number<int>(word).has_value()) << word;
}

}  // namespace
}  // namespace dihaptic::number_test
