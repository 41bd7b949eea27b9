// All of bench grasp through the makers' libraries (our fakes of them): the same figures as on the
// simulated devices themselves. src/measure/test/makers_test.cpp has the main ones.
#include <nlohmann/json.hpp>

#include "measure/test/makers.h"

namespace dihaptic::measure {
namespace {

class MakersSoak : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Backends, MakersSoak, ::testing::Values("openhaptics", "forcedimension"));

/// Every number of both, under the same names. Below a thousandth, of whatever unit the bench
/// prints, figures are as good as zero.
void expect_alike(const nlohmann::json& a, const nlohmann::json& b, const std::string& name) {
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

TEST_P(MakersSoak, AllFiguresAreTheSame) {
    const BenchSetup simulated;
    const BenchSetup made = by_maker(simulated, GetParam());
    const GraspFigures a = bench_grasp(simulated, {});
    const GraspFigures b = bench_grasp(made, {});
    expect_alike(nlohmann::json::parse(to_json(a, simulated)),
                 nlohmann::json::parse(to_json(b, made)), "grasp");
}

}  // namespace
}  // namespace dihaptic::measure
