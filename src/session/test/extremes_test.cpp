// Tests extreme settings and changed files: each one must either be refused with an error or end
// properly.
#include "extremes.h"

namespace dihaptic::session::extremes_test {
namespace {

constexpr Time kFirst = std::chrono::milliseconds(1500);  // the hand has closed its grasp by then

void expect_order(const Request& request) {
    const Ending ending = ending_of([&] { return run_extreme(request, kFirst); }, 60);
    EXPECT_TRUE(ending != Ending::crashed && ending != Ending::hung)
        << enum_name(ending) << ": " << words(request);
}

TEST(ExtremeSettings, EndInOrderOrAreRefused) {
    Endings endings;
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        const Request request = extreme_request(seed);
        const Ending ending = ending_of([&] { return run_extreme(request, kFirst); }, 60);
        ++endings[ending];
        EXPECT_TRUE(ending != Ending::crashed && ending != Ending::hung)
            << enum_name(ending) << ": " << words(request);
    }
    // both kinds of ending must be among the results
    EXPECT_GT(endings[Ending::in_order], 5) << words(endings);
    EXPECT_GT(endings[Ending::refused], 5) << words(endings);
}

TEST(ExtremeSettings, OfALightDualSpringEndInOrder) {
    for (const std::vector<std::string>& set : std::vector<std::vector<std::string>>{
             {"coupling.body_mass_g=1"},
             {"coupling.body_mass_g=2", "coupling.stiffness_N_m=2000"},
             {"coupling.body_damping_across_Ns_m=100"},
             {"coupling.stiffness_N_mm=100"},
             {"coupling.stiffness_N_mm=100", "coupling.body_mass_g=0.1"}}) {
        for (const char* file :
             {"experiments/lift-block.yaml", "experiments/reach-to-grasp.yaml"}) {
            Request request;
            request.file = file;
            if (request.file.find("reach") != std::string::npos)
                request.movement = "movements/reach-to-grasp.csv";
            request.set = set;
            request.set.push_back("coupling.kind=dual_spring");
            expect_order(request);
        }
    }
}

TEST(MutatedFiles, AreReadOrRefused) {
    const MutatedFiles files;
    Endings endings;
    std::string file, text;
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        const Ending ending = files.check(seed, file, text);
        ++endings[ending];
        EXPECT_TRUE(ending != Ending::crashed && ending != Ending::hung)
            << enum_name(ending) << ", seed " << seed << ": " << file << "\n"
            << text;
    }
    EXPECT_GT(endings[Ending::refused], 20) << words(endings);
}

}  // namespace
}  // namespace dihaptic::session::extremes_test
