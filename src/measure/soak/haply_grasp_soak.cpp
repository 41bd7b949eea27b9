// Compares all figures of `dihaptic bench grasp` for Inverse3 devices behind a fake service with
// the figures for the same devices simulated directly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/figure_text.h"
#include "measure/grasp.h"
#include "measure/test/alike.h"
#include "measure/test/through_haply.h"

namespace dihaptic::measure {
namespace {

TEST(HaplyGraspSoak, HasTheFiguresOfTheSimulatedDevices) {
    const BenchSetup setup;
    const GraspFigures simulated = bench_grasp(setup, {});
    std::unique_ptr<devices::haply::FakeService> service;
    const GraspFigures haply = bench_grasp(through_haply(setup, service), {});
    fmt::print("{}\n{}\n", figure_text(simulated), figure_text(haply));
    expect_alike(nlohmann::json::parse(to_json(haply)), nlohmann::json::parse(to_json(simulated)),
                 "grasp");
}

}  // namespace
}  // namespace dihaptic::measure
