// Whether two runs of a bench gave the same figures.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace dihaptic::measure {

/// Every number of both, under the same names. Below a thousandth, of whatever unit the bench
/// prints, figures are as good as zero.
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
            expect_alike(value, a.is_array() ? b[std::stoul(key)] : b[key], name + "." + key);
    } else {
        EXPECT_EQ(a, b) << name;
    }
}

}  // namespace dihaptic::measure
