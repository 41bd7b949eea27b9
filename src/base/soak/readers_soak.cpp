// Reads large and damaged YAML files. The reading time must be proportional to the size rather than
// its square, and each of ten thousand damaged files must be either read or refused with a line
// number.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "base/node.h"
#include "base/random.h"

namespace dihaptic {
namespace {

std::string keys(int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += fmt::format("key{}: [1, two, {{three: 3}}]\n", i);
    return out;
}

/// Reads a text three times and returns the shortest time [s].
double time_to_read(const std::string& text) {
    double shortest = 1e9;
    for (int i = 0; i < 3; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        (void)parse_yaml(text, "a.yaml");
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        shortest = std::min(shortest, took.count());
    }
    return shortest;
}

TEST(ReadersSoak, FourTimesAsManyKeysTakeFourTimesAsLong) {
    const double one = time_to_read(keys(15'000));
    const double four = time_to_read(keys(60'000));
    fmt::print("{:.3f} s, {:.3f} s\n", one, four);
    EXPECT_LT(four, 10 * one);
}

TEST(ReadersSoak, TenThousandDamagedFilesAreReadOrRefused) {
    const std::string whole = keys(30) + "list:\n  - &a {name: b, size: [1, 2]}\n  - *a\n";
    const std::string signs = "[]{},:&*!|>'\"#%@`?-\n\t ~";
    Random random(1, "damage");
    int refused = 0;
    const auto below = [&](size_t count) {
        return static_cast<size_t>(random.uniform(0, static_cast<double>(count)));
    };
    for (int i = 0; i < 10'000; ++i) {
        std::string text = whole;
        for (size_t n = 1 + below(4); n > 0; --n)
            text.insert(below(text.size()), 1 + below(3), signs[below(signs.size())]);
        try {
            (void)parse_yaml(text, "a.yaml");
        } catch (const Error& e) {
            ++refused;
            EXPECT_GE(e.problems().front().place.line, 1) << text;
        }
    }
    fmt::print("{} of 10000 refused\n", refused);
    EXPECT_GT(refused, 1000);
    EXPECT_LT(refused, 9000);
}

}  // namespace
}  // namespace dihaptic
