// Tests the error message for every mistake that perturbations, their profiles and their loads can
// contain.
#include <gtest/gtest.h>

#include "session/test/reaches.h"

namespace dihaptic::task::load_mistakes_test {
namespace {

using session::Mistake;

class BrokenLoad : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenLoad, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

const char* const kField =
    "field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
    "damping_Ns_m: 5 }";
const char* const kPerturb = "perturb: rotation";

INSTANTIATE_TEST_SUITE_P(
    Loads, BrokenLoad,
    ::testing::Values(
        Mistake{kField, "loads: { kind: viscous, on: index, damping_Ns_m: 1 }", "must be a list"},
        Mistake{kField, "loads: [{ on: index, damping_Ns_m: 1 }]", "kind"},
        Mistake{kField, "loads: [{ kind: elastic, on: index }]", "'elastic' is not known"},
        Mistake{kField, "loads: [{ kind: viscous, damping_Ns_m: 1 }]", "on: is missing"},
        Mistake{kField, "loads: [{ kind: viscous, on: [], damping_Ns_m: 1 }]", "has no items"},
        Mistake{kField, "loads: [{ kind: viscous, on: [index, blok], damping_Ns_m: 1 }]",
                "Did you mean block?"},
        Mistake{kField, "loads: [{ kind: viscous, on: [index, index], damping_Ns_m: 1 }]",
                "named twice"},
        Mistake{kField, "loads: [{ kind: viscous, on: table, damping_Ns_m: 1 }]",
                "'table' cannot move"},
        Mistake{kField, "loads: [{ kind: viscous, on: index }]", "would do nothing"},
        Mistake{kField, "loads: [{ kind: viscous, on: index, damping: 1 }]", "needs its unit"},
        Mistake{kField, "loads: [{ kind: viscous, on: index, damping_Ns_m: 1, stiffness_N_m: 5 }]",
                "stiffness_N_m: is not known here"},
        Mistake{kField, "loads: [{ kind: curl, on: index, damping_Ns_m: 1, axis: [0, 0, 0] }]",
                "axis: has no direction"},
        Mistake{kField, "loads: [{ kind: constant, on: index }]", "would do nothing"},
        Mistake{kField, "loads: [{ kind: constant, on: index, force_N: 3 }]",
                "must be three numbers"},
        Mistake{kField, "loads: [{ kind: constant, on: index, force_N: [1, 0, 0], delay_ms: 5 }]",
                "delay_ms: is not known here"},
        Mistake{kField, "loads: [{ kind: constant, on: index, torque_Nm: [0, 0, 0.1] }]",
                "renders no torque"},
        Mistake{kField, "loads: [{ kind: general, on: index }]", "and so are 'B' and 'force'"},
        Mistake{kField, "loads: [{ kind: general, on: index, B_Ns_m: [0, -13, 0] }]",
                "three rows of three numbers"},
        Mistake{kField,
                "loads: [{ kind: general, on: index, B_Ns_m: [[0, 1, 0], [0, x, 0], [0, 0, 0]] }]",
                "must be a number, but is 'x'"},
        Mistake{
            kField,
            "loads: [{ kind: general, on: index, A_N_m: [[-1, 0, 0], [0, -1, 0], [0, 0, -1]] }]",
            "about: is missing"},
        Mistake{kField,
                "loads: [{ kind: general, on: index, about: start, "
                "A_N_m: [[9, 0, 0], [0, -1, 0], [0, 0, -1]] }]",
                "like a spring of -9 N/m"},
        Mistake{kField, "loads: [{ kind: spring, on: index, about: start }]",
                "a spring needs a stiffness"},
        Mistake{kField, "loads: [{ kind: spring, on: index, stiffness_N_m: 9 }]", "from"},
        Mistake{kField, "loads: [{ kind: spring, on: index, about: strat, stiffness_N_m: 9 }]",
                "Did you mean start?"},
        Mistake{kField, "loads: [{ kind: spring, on: index, about: start, stiffness_N_m: -9 }]",
                "safe_within_mm: 50"},
        Mistake{kField,
                "loads: [{ kind: spring, on: index, about: start, to: target, stiffness_N_m: 9 }]",
                "to: cannot be used here"},
        Mistake{kField,
                "loads: [{ kind: spring, on: index, from: start, to: target, stiffness_N_m: 9, "
                "normal: [0, 0, 1] }]",
                "normal: cannot be used here"},
        Mistake{kField,
                "loads: [{ kind: spring, on: index, about: start, axis: [1, 0, 0], "
                "normal: [0, 0, 1], stiffness_N_m: 9 }]",
                "Keep only one of them"},
        Mistake{kField,
                "loads: [{ kind: spring, on: index, about: start, stiffness_N_m: 9, one_sided: yes "
                "}]",
                "needs a plane with a normal"},
        Mistake{kField,
                "loads: [{ kind: spring, on: index, about: start, normal: [0, 0, 1], one_sided: "
                "yes, stiffness_N_m: -9, safe_within_mm: 9 }]",
                "a wall cannot have"},
        Mistake{kField, "loads: [{ kind: channel, on: index, about: start, stiffness_N_m: 9 }]",
                "needs a line or plane"},
        Mistake{kField,
                "loads: [{ kind: channel, on: index, from: start, to: target, stiffness_N_m: -9 }]",
                "stiffness_N_m: must be at least 0"},
        Mistake{kField,
                "loads: [{ kind: channel, on: index, from: start, to: target, stiffness_N_m: 9, "
                "break_out_mm: 0 }]",
                "break_out_mm: must be positive"},
        Mistake{kField,
                "loads: [{ kind: channel, on: index, from: start, to: target, stiffness_N_m: 9, "
                "delay_ms: 5000 }]",
                "delay_ms"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      during: [rech]\n",
                "Did you mean reach?"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      during: home\n",
                "has 'perturbed: no'"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      profile: { fall_ms: 20 }\n",
                "has no effect without a plateau"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      profile: { rise: 20 }\n",
                "needs its unit"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      profile: { shape: round }\n",
                "Use linear or minimum_jerk"},
        Mistake{"    - name: clamp\n", "    - name: clamp\n      profile: { rise_ms: -20 }\n",
                "rise_ms: must be at least 0"},
        Mistake{kPerturb, "perturb: [rotation, clamp]", "both change the display in state 'reach'"},
        Mistake{kPerturb, "perturb: [rotation, rotation]", "named twice"},
        Mistake{kPerturb, "perturb: [rotation, chanel]", "Did you mean channel?"},
        Mistake{kPerturb, "perturb: { rotation: 1 }", "must be a text or a list of texts"},
        Mistake{kPerturb, "perturb: [a, b, c, d, e, f, g, h, i]", "at most 8 are allowed"},
        Mistake{"insert: [{ kind: catch, count: 1 }]",
                "insert: [{ kind: catch, count: 1, perturb: [clamp, rotation] }]",
                "both change the display"}));

TEST(Loads, MoreThanATickHoldsAreRefused) {
    session::Files files;
    std::string loads = "loads: [";
    for (int i = 0; i < 17; ++i)
        loads += std::string(i > 0 ? ", " : "") + "{ kind: viscous, on: index, damping_Ns_m: 0.1 }";
    files.replace("perturb: clamp", "perturb: channel");
    session::expect_refused(files, {kField, (loads + "]").c_str(), "makes 17 loads act"});
}

TEST(Loads, ANameWithTheSignThatJoinsSeveralStandsOnlyByItself) {
    session::Files files;
    files.replace("    - name: clamp\n", "    - name: a + b\n");
    files.replace("perturb: clamp", "perturb: a + b");
    Diagnostics diagnostics;
    session::check_file(files.request().file, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors());
    session::expect_refused(
        files, {"perturb: a + b", "perturb: [a + b, channel]", "would be read as several"});
}

}  // namespace
}  // namespace dihaptic::task::load_mistakes_test
