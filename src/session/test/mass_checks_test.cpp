// Tests the warnings about masses that the world's time step cannot handle, including the numbers
// in them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "session/plan.h"
#include "testing/files.h"

namespace dihaptic::session::mass_checks_test {
namespace {

/// Returns the messages about a scene when it is planned.
std::string said_of(const std::string& bodies, const std::string& more = "") {
    testing::TemporaryFolder folder;
    Request request;
    request.file = folder.write(
        "scene.yaml", "bodies:\n  - { name: floor, shape: plane, fixed: yes }\n" + bodies + more);
    std::string out;
    for (const Problem& problem : make_plan(request).warnings) {
        out += problem.text() + "\n";
        EXPECT_GT(problem.place.line, 0);
    }
    return out;
}

std::string box(const std::string& name, double mass_g, double z_mm) {
    return fmt::format(
        "  - {{ name: {}, shape: box, size_mm: [40, 40, 40], mass_g: {}, "
        "position_mm: [0, 0, {}] }}\n",
        name, mass_g, z_mm);
}

/// Returns a chain of links, each 3 x 3 x 8 mm, on ball joints, carrying a load.
std::string chain(double link_g, double load_g) {
    constexpr int kLinks = 20;
    std::string bodies, joints = "joints:\n";
    for (int i = 0; i <= kLinks; ++i) {
        const bool is_load = i == kLinks;
        bodies += fmt::format(
            "  - {{ name: l{}, shape: box, size_mm: {}, mass_g: {}, "
            "position_mm: [0, 0, {}] }}\n",
            i, is_load ? "[60, 60, 60]" : "[3, 3, 8]", is_load ? load_g : link_g,
            500 - 8 * i - (is_load ? 30 : 4));
        joints += fmt::format(
            "  - {{ name: j{0}, kind: ball, between: [{1}l{0}], position_mm: [0, "
            "0, {2}] }}\n",
            i, i == 0 ? "" : fmt::format("l{}, ", i - 1), 500 - 8 * i);
    }
    return bodies + joints;
}

TEST(MassChecks, SayWhichSolverHoldsWhichRatio) {
    const auto stack = [](double light_g, const std::string& solver) {
        return said_of(box("light", light_g, 20) + box("heavy", 20000, 60),
                       "settings: { dynamics: { solver: " + solver + " } }\n");
    };
    EXPECT_EQ(stack(1, "newton"), "");
    EXPECT_EQ(stack(0.02, "staggered_projections"), "");
    const std::string said = stack(0.02, "newton");
    EXPECT_NE(said.find("has 1e+06 times the mass of light"), std::string::npos) << said;
    EXPECT_NE(said.find("staggered_projections"), std::string::npos) << said;
    EXPECT_NE(stack(1, "sequential_impulse"), "");
}

TEST(MassChecks, SayWhatAChainOfLightLinksCannotCarry) {
    // measured: links of 1 g hold 200 g at 1 kHz; with 500 g they hold only at 2 kHz
    EXPECT_EQ(said_of(chain(1, 200)), "");
    EXPECT_EQ(said_of(chain(10, 500)), "");
    const std::string said = said_of(chain(1, 500));
    EXPECT_NE(said.find("l0: is so light that the suspended load of 5.1 N turns it at 2590 rad/s"),
              std::string::npos)
        << said;
    EXPECT_EQ(said_of(chain(1, 500), "settings: { rate_Hz: 2000 }\n"), "");
}

}  // namespace
}  // namespace dihaptic::session::mass_checks_test
