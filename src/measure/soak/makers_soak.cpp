// Tests that all figures of bench grasp are the same for fakes of the manufacturers' libraries as
// for the simulated devices themselves. src/measure/test/makers_test.cpp tests only the main
// figures.
#include "measure/test/alike.h"
#include "measure/test/makers.h"

namespace dihaptic::measure {
namespace {

class MakersSoak : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Backends, MakersSoak, ::testing::Values("openhaptics", "forcedimension"));

TEST_P(MakersSoak, AllFiguresAreTheSame) {
    const BenchSetup simulated;
    const BenchSetup made = by_maker(simulated, GetParam());
    const GraspFigures a = bench_grasp(simulated, {});
    const GraspFigures b = bench_grasp(made, {});
    expect_alike(nlohmann::json::parse(to_json(a)), nlohmann::json::parse(to_json(b)), "grasp");
}

}  // namespace
}  // namespace dihaptic::measure
