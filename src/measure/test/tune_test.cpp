#include "measure/tune.h"

#include <gtest/gtest.h>

namespace dihaptic::measure::tune_test {
namespace {

const std::vector<std::string> kFingers{"thumb", "index"};

/// Sets up a short search with one row, around the stiffness at which the ideal plant stops being
/// calm with margin.
TuneSetup small_search() {
    TuneSetup setup =
        tune_setup(rig::simulated_rig(kFingers), kFingers, frame::Settings{}, hand::Impedance{});
    setup.stiffness = {1300, 2600, 5200};
    setup.damping = {1};
    return setup;
}

TEST(Tune, ProposesWhatIsCalmUnderEveryBurdenAndNoMuchStiffer) {
    const TuneSetup setup = small_search();
    const TuneResult searched = tune(setup, false, {});
    ASSERT_TRUE(searched.proposal);
    TunePoint proposal = *searched.proposal;
    EXPECT_TRUE(proposal.calm_with_margin());
    EXPECT_GT(proposal.k, 1300);
    EXPECT_TRUE(searched.map.front().calm_with_margin());
    EXPECT_NE(settings_block(searched, setup).find("damping_Ns_m: 1\n"), std::string::npos);
    // the benchmark agrees, and 1.5 times the stiffness is too much under one of the burdens
    int too_much = 0;
    for (const Burden burden :
         {Burden::none, Burden::delay, Burden::light, Burden::loose, Burden::firm}) {
        EXPECT_TRUE(calm_grasp(measure_hold(hold_setup(setup, proposal, burden))))
            << enum_name(burden);
        TunePoint stiffer = proposal;
        stiffer.k *= 1.5;
        too_much += !calm_grasp(measure_hold(hold_setup(setup, stiffer, burden)));
    }
    EXPECT_GT(too_much, 0);
    EXPECT_FALSE(searched.stiffer->calm_with_margin());
}

TEST(Tune, ComesOutTheSameOnAnyNumberOfThreads) {
    TuneSetup setup = small_search();
    setup.stiffness = {1300};
    setup.threads = 1;
    const std::string alone = to_json(tune(setup, false, {}), setup);
    setup.threads = 3;
    EXPECT_EQ(to_json(tune(setup, false, {}), setup), alone);
}

TEST(Tune, BurdensChangeWhatTheyName) {
    TuneSetup setup = small_search();
    setup.hand.stiffness_per_force = 60;
    const TunePoint point{1000, 2, 1, {}};
    for (const Burden burden :
         {Burden::none, Burden::delay, Burden::light, Burden::loose, Burden::firm}) {
        const BenchSetup hold = hold_setup(setup, point, burden);
        EXPECT_NEAR(press_force(hold), 0.4 * 8.5, 1e-12) << "every hand grips as hard";
        EXPECT_EQ(hold.settings.coupling.stiffness, 1000);
        EXPECT_EQ(hold.settings.coupling.damping, 2);
    }
    EXPECT_EQ(hold_setup(setup, point, Burden::delay).row, Row::delay);
    EXPECT_EQ(hold_setup(setup, point, Burden::light).mass, 0.01);
    EXPECT_EQ(hold_setup(setup, point, Burden::loose).impedance.stiffness, 100);
    EXPECT_EQ(hold_setup(setup, point, Burden::firm).impedance.damping, 9);
}

TEST(Tune, KeepsTheRigsDevicesAndAddsToTheirDelay) {
    const auto hold = [](const char* options, Burden burden) {
        rig::Rig rig = rig::simulated_rig(kFingers);
        for (rig::Device& device : rig.devices) device.options = parse_yaml(options, "rig");
        const TuneSetup setup = tune_setup(rig, kFingers, frame::Settings{}, hand::Impedance{});
        EXPECT_NEAR(setup.grip, 1.2, 1e-12);
        return measure_hold(hold_setup(setup, {2000, 1, 1, {}}, burden));
    };
    const char* late = "{peak_force_N: 3, delay_ticks: 1}";
    const char* later = "{peak_force_N: 3, delay_ticks: 2}";
    EXPECT_EQ(hold(late, Burden::delay).hf_force_n, hold(later, Burden::none).hf_force_n);
    EXPECT_NE(hold(late, Burden::none).hf_force_n, hold(later, Burden::none).hf_force_n);
}

TEST(Tune, GripsNoHarderThanMotorsBearForLong) {
    Diagnostics diagnostics;
    rig::Rig rig = rig::read_rig("rigs/premium-pair.yaml", diagnostics);
    for (const char* preset : {"premium_1_0", "touch"}) {
        for (rig::Device& device : rig.devices)
            device.options = parse_yaml(std::string("preset: ") + preset, "here");
        TuneSetup setup = tune_setup(rig, kFingers, frame::Settings{}, hand::Impedance{});
        setup.stiffness = {740};
        setup.damping = {1};
        const TuneResult searched = tune(setup, false, {});
        EXPECT_TRUE(searched.map.front().calm(Burden::none)) << preset;
    }
}

TEST(Tune, StopsWhenAskedTo) {
    const TuneResult result = tune(small_search(), true, {});
    EXPECT_TRUE(result.interrupted);
    EXPECT_FALSE(result.proposal);
}

TEST(Tune, RefusesWhatItCannotSimulate) {
    rig::Rig rig = rig::simulated_rig(kFingers);
    rig.devices[1].backend = "replay";
    rig.devices[1].place = {"rig.yaml", 7};
    const auto message = [&](const std::vector<std::string>& fingers) -> std::string {
        try {
            tune_setup(rig, fingers, frame::Settings{}, hand::Impedance{});
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(message(kFingers).find("rig.yaml:7: error: backend: 'replay' cannot be tuned"),
              std::string::npos)
        << message(kFingers);
    EXPECT_NE(message({"thumb", "toe"}).find("the scene's finger 'toe' holds no device"),
              std::string::npos);
    EXPECT_NE(message({"thumb"}).find("the scene has only thumb"), std::string::npos);
}

TEST(Tune, TheMapShowsEverySettingAndTheProposal) {
    const TuneSetup setup = small_search();
    constexpr Verdict calm = Verdict::calm;
    constexpr Verdict shaking = Verdict::shaking;
    TuneResult found;
    found.map = {{1300, 1, 1, {calm, calm, calm, calm, calm}},
                 {2600, 1, 1, {calm, shaking, calm, calm, calm}},
                 {5200, 1, 1, {shaking}}};
    found.proposal = {1700, 1, 1, {calm, calm, calm, calm, calm}};
    const std::string svg = tune_map(found, setup, "A <rig> & more");
    EXPECT_EQ(svg.find("<rig>"), std::string::npos);
    EXPECT_NE(svg.find("A &lt;rig&gt; &amp; more"), std::string::npos);
    for (const char* words :
         {"1300 N/m, 1 N*s/m: calm with margin", "2600 N/m, 1 N*s/m: calm, but not with D",
          "5200 N/m, 1 N*s/m: shaking", "★ proposal: 1700 N/m, 1 N·s/m"})
        EXPECT_NE(svg.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace dihaptic::measure::tune_test
