// Tests the error message for every mistake that a task's file can have.
#include <gtest/gtest.h>

#include "session/test/reaches.h"

namespace dihaptic::task::task_mistakes_test {
namespace {

using session::Mistake;

class BrokenFile : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenFile, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

const char* const kExit = "{ when: outside, region: shell, outcome: reached, feedback: Good }";
const char* const kRotation =
    "visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }";
const char* const kChannel =
    "field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
    "damping_Ns_m: 5 }";
const char* const kReach =
    "reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }";
const char* const kBlock = "{ name: before, kind: baseline, repeats: 1 }";

INSTANTIATE_TEST_SUITE_P(
    Task, BrokenFile,
    ::testing::Values(
        Mistake{"name: shell,", "name: target,", "there are two regions 'target'"},
        Mistake{"name: shell,", "nam: shell,", "nam"},
        Mistake{"name: start, position_mm: [0, 0, 120]", "name: start", "position"},
        Mistake{"position_mm: [50, 0, 120]", "position_mm: [50, 120]", "must be three numbers"},
        Mistake{"position_mm: [50, 0, 120]", "position: [50, 0, 120]", "position"},
        Mistake{"radius_mm: 45", "radius_mm: -45", "radius_mm"},
        Mistake{"marker: 7", "hed: 'Sensory-event, (Target'", "has a '(' without a ')'"},
        Mistake{"marker: 7", "hed: 'Sensory-event)'", "has a ')' without a '('"},
        Mistake{"marker: 7", "hed: 'Sensory-event,, Target'", "has an empty tag before a ','"},
        Mistake{"marker: 7", "hed: '(), Target'", "has an empty tag before a ')'"},
        Mistake{"marker: 7", "hed: 'Sensory-event,'", "ends with an empty tag"},
        Mistake{"marker: 7", "hed: '{value}'", "contains the character '{'"},
        Mistake{"hold_s: 0.2, to: reach", "hold_s: 0.2, to: reach, hed: Target",
                "belongs to an exit with an outcome"},
        Mistake{"name: clamp\n", "name: clamp\n      hed: '~Target'\n",
                "contains the character '~'"},
        Mistake{"reach: target }]", "reach: target, move_mm: [0, index.y, 0] }]",
                "changes within a trial"},
        Mistake{"task:\n", "task:\n  participants: [A]\n", "'A' is not a hand of the task"},
        Mistake{"task:\n", "task:\n  hands: [{ name: A, fingers: [index] }]\n  participants: [A]\n",
                "has 1 hand, but a task is for one participant or two"},
        Mistake{"task:\n",
                "task:\n  hands: [{ name: A, fingers: [index] }, { name: B, fingers: [index] }]\n"
                "  participants: [A, B]\n",
                "must have all fingers of the scene"},
        Mistake{"task:\n", "task:\n  corrections: { after: reach, axis: [0, 0, 0] }\n",
                "has no direction"},
        Mistake{"task:\n", "task:\n  corrections: { after: reahc }\n", "Did you mean reach?"},
        Mistake{"task:\n", "task:\n  corrections: { after: reach, matched: [right, far] }\n",
                "names all conditions"},
        Mistake{"name: clamp\n", "name: rotation\n", "there are two perturbations 'rotation'"},
        Mistake{kRotation, "visual: { moves: [proxy], about: start }",
                "'proxy' is not an object that can be moved"},
        Mistake{kRotation, "visual: { about: start, angle_deg: 30 }", "moves"},
        Mistake{kRotation, "visual: { moves: [proxies], about: strat }", "Did you mean start?"},
        Mistake{kRotation, "visual: { moves: [proxies], about: start, angle_deg: 30 }", "axis"},
        Mistake{kRotation,
                "visual: { moves: [proxies], about: start, axis: [0, 0, 0], angle_deg: 30 }",
                "has no direction"},
        Mistake{kRotation, "visual: { moves: [proxies], about: start, size: 2 }",
                "needs the object among moves"},
        Mistake{"toward: target }", "toward: target, axis: [0, 0, 1], angle_deg: 3 }",
                "neither rotated nor scaled"},
        Mistake{kRotation, "body: { body: blok, mass_scale: [2, 2, 1] }", "Did you mean block?"},
        Mistake{kRotation, "body: { body: table, mass_scale: [2, 2, 1] }", "'table' cannot move"},
        Mistake{kRotation, "body: { body: table, friction_scale: 2, weight_scale: 2 }",
                "or change only its friction and surface"},
        Mistake{kRotation, "body: { body: block, mass_scale: 2 }", "must be three numbers"},
        Mistake{kRotation, "body: { body: block, weight_scale: heavy }", "must be a number"},
        Mistake{kRotation, "visual:", "visual"},
        Mistake{kChannel, "field: { kind: tunnel, on: index }", "tunnel"},
        Mistake{kChannel, "field: { kind: viscous, on: index }", "damping"},
        Mistake{kChannel, "field: { kind: viscous, on: idnex, damping_Ns_m: 5 }",
                "Did you mean index?"},
        Mistake{kChannel, "field: { kind: curl, on: index, damping_Ns_m: 5 }", "axis"},
        Mistake{kChannel, "field: { kind: channel, on: index, from: start, to: target }",
                "stiffness"},
        Mistake{kChannel, "field: { kind: channel, on: index, stiffness_N_m: 500 }", "from"},
        Mistake{"name: reach\n      show", "name: home\n      show", "there are two states 'home'"},
        Mistake{"show: [target]", "show: [tarket]", "Did you mean target?"},
        Mistake{"{ when: time, after_s: 5", "{ when: time, after: 5", "after_s"},
        Mistake{kExit, "{ when: outside, region: shell, after_s: 1, outcome: reached }",
                "It belongs to when: time."},
        Mistake{"marker: 7", "marker: 700", "marker"},
        Mistake{"marker: 7", "marker: seven", "marker"},
        Mistake{kExit, "{ region: shell, outcome: reached }", "when"},
        Mistake{kExit, "{ when: outside, region: shel, outcome: reached }", "Did you mean shell?"},
        Mistake{kExit, "{ when: outside, outcome: reached }", "region"},
        Mistake{kExit, "{ when: outside, region: shell }", "leads nowhere"},
        Mistake{kExit, "{ when: outside, region: shell, to: home, outcome: reached }",
                "has more than one destination"},
        Mistake{kExit, "{ when: outside, region: shell, to: hom }", "Did you mean home?"},
        Mistake{kExit, "{ when: outside, region: shell, finger: thumb, outcome: reached }",
                "a finger of the scene"},
        Mistake{kExit, "{ when: outside, region: shell, outcome: lost }",
                "'lost' are repeated after one exit"},
        Mistake{kExit, "{ when: outside, region: shell, outcome: skipped }",
                "is reserved for trials"},
        Mistake{kExit, "{ when: lifted, body: table, outcome: reached }", "'table' cannot move"},
        Mistake{kExit, "{ when: gripped, body: block, outcome: reached }", "a grip takes two"},
        Mistake{kExit, "{ when: key, key: enter, outcome: reached }", "is not a valid key"},
        Mistake{kExit, "{ when: time, outcome: reached }", "the duration is missing"},
        Mistake{kExit, "{ when: trigger, code: 256, outcome: reached }", "code"},
        Mistake{kExit, "{ when: trigger, hold_s: 1, outcome: reached }",
                "a trigger has no duration"},
        Mistake{kExit, "{ when: button, button: 40, outcome: reached }", "button"},
        Mistake{kExit, "{ when: outside, region: shell, height_mm: 20, outcome: reached }",
                "height_mm"},
        Mistake{"duration_s: 0.2, reach: target", "duration_s: 0, reach: target", "duration_s"},
        Mistake{"duration_s: 0.2, reach: target", "reach: target", "duration"},
        Mistake{"duration_s: 0.2, reach: target", "duration_s: 0.2, fingers: [indx]",
                "Did you mean index?"},
        Mistake{"during: reach", "during: rech", "Did you mean reach?"},
        Mistake{"distance_mm: 30", "distance_mm: 0", "distance_mm"},
        Mistake{"name: far\n", "name: right\n", "there are two conditions 'right'"},
        Mistake{"name: far\n", "name: far\n      object: table\n", "'table' cannot move"},
        Mistake{"name: far\n", "name: far\n      object: blok\n", "Did you mean block?"},
        Mistake{"[{ name: target, position_mm: [0, 50, 120]",
                "[{ name: targe, position_mm: [0, 50, 120]", "Did you mean target?"},
        Mistake{"redo: next", "redo: later", "redo"},
        Mistake{kBlock, "{ name: before, kind: base }", "kind"},
        Mistake{kBlock, "{ name: before, conditions: [left] }", "'left' is not a condition"},
        Mistake{kBlock, "{ name: before, repeats: 0 }", "repeats"},
        Mistake{kBlock, "{ name: before, order: random }", "order"},
        Mistake{kBlock, "{ name: before, kind: perturbed }", "is missing in a perturbed block"},
        Mistake{kBlock, "{ name: before, ramp: 3 }", "ramp: needs a perturbation"},
        Mistake{kBlock, "{ name: before, kind: error_clamp, perturb: clamp }",
                "'error_clamp' is no longer allowed. Write visual_clamp"},
        Mistake{kBlock, "{ name: before, kind: visual_clamp }", "is missing in a visual_clamp"},
        Mistake{kBlock, "{ name: before, kind: visual_clamp, perturb: channel }",
                "'channel' is a force channel. Write kind: force_channel"},
        Mistake{kBlock, "{ name: before, kind: force_channel, perturb: clamp }",
                "'clamp' is not a force channel. Name a perturbation whose field is a channel"},
        Mistake{"kind: catch, count: 1", "kind: force_channel, count: 1",
                "is missing in a force_channel"},
        Mistake{"perturb: rotation", "perturb: rotatoin", "Did you mean rotation?"},
        Mistake{"count: 1 }", "count: 5 }", "but the block has only 4 trials"},
        Mistake{"  blocks:\n", "  block:\n", "blocks"}));

INSTANTIATE_TEST_SUITE_P(
    Measures, BrokenFile,
    ::testing::Values(
        Mistake{"redo: next", "measures: [reaction_tim]", "Did you mean reaction_time?"},
        Mistake{"redo: next", "measures: [peak_speed, peak_speed]", "'peak_speed' is listed twice"},
        Mistake{kReach, "measures: [peak_speed]", "measures of movement are listed"},
        Mistake{"redo: next", "measures: [peak_grip]", "need a movable object and two fingers"},
        Mistake{"redo: next", "measures: [grip_latency]", "starts at a load step"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { of: inde }",
                "Did you mean index?"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { of: table }",
                "'table' is neither a finger, a movable body nor hand"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { from: strat }",
                "Did you mean start?"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { to: start }",
                "is the same region as from"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { during: [rech] }",
                "Did you mean reach?"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { go: hom }",
                "Did you mean home?"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { axis: [0, 0, 0] }",
                "has no direction"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { onset_speed_mm_s: 0 }",
                "onset_speed_mm_s"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { onset: 5 }", "onset"},
        Mistake{"redo: next",
                "measures: [lateral_deviation]\n  movement: { error: lateral_deviaton }",
                "Did you mean lateral_deviation?"},
        Mistake{"redo: next", "measures: [peak_speed]\n  movement: { error: path_length }",
                "'path_length' is not a value of the listed measures"},
        Mistake{"redo: next", "measures: [channel_force]\n  movement: { of: block }",
                "no channel acts on 'block'"},
        Mistake{"redo: next", "measures: [adaptation_index]", "needs a field that is learned"},
        Mistake{"redo: next", "measures: [adaptation_index]\n  movement: { ideal: chanel }",
                "Did you mean channel?"},
        Mistake{"redo: next", "measures: [adaptation_index]\n  movement: { ideal: channel }",
                "'channel' has no velocity-dependent field on 'index'"}));

}  // namespace
}  // namespace dihaptic::task::task_mistakes_test
