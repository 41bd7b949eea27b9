// Compares the figures of two runs of a benchmark.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/number.h"

namespace dihaptic::measure {

/// Expects the same numbers under the same names. Figures below 0.001, in the unit in which the
/// benchmark prints them, count as zero.
inline void expect_alike(const nlohmann::json& a, const nlohmann::json& b,
                         const std::string& name) {
    ASSERT_EQ(a.type(), b.type()) << name;
    ASSERT_EQ(a.size(), b.size()) << name;
    if (a.is_number()) {
        EXPECT_NEAR(a.get<double>(), b.get<double>(),
                    std::max(0.01 * std::abs(a.get<double>()), 1e-3))
            << name;
    } else if (a.is_structured()) {
        for (const auto& [key, value] : a.items())
            expect_alike(value, a.is_array() ? b[whole_number<size_t>(key).value()] : b[key],
                         name + "." + key);
    } else {
        EXPECT_EQ(a, b) << name;
    }
}

}  // namespace dihaptic::measure
