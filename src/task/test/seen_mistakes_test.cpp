// Tests the error message for every mistake in the keys that determine what a person sees.
#include <gtest/gtest.h>

#include "session/test/reaches.h"

namespace dihaptic::task::seen_mistakes_test {
namespace {

using session::Mistake;

class BrokenSight : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenSight, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

const char* const kShow = "show: [target]";
const char* const kMessage = "message: Go home";
const char* const kRotation =
    "visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }";
const char* const kBlock = "{ name: before, kind: baseline, repeats: 1 }";

INSTANTIATE_TEST_SUITE_P(
    Show, BrokenSight,
    ::testing::Values(
        Mistake{kShow, "show: { targets: [tarket] }", "Did you mean target?"},
        Mistake{kShow, "show: { target: [target] }", "Did you mean targets?"},
        Mistake{kShow, "show: target", "must have keys of its own"},
        Mistake{kShow, "show: { cursor: maybe }", "'maybe' is not known"},
        Mistake{kShow, "show: { object: perhaps }", "must be yes or no"},
        Mistake{kShow, "show: { bodies: [block] }", "must have one key for each hidden item"},
        Mistake{kShow, "show: { bodies: { blok: no } }", "Did you mean block?"},
        Mistake{kShow, "show: { bodies: { block: maybe } }", "must be yes or no"},
        Mistake{kShow, "show: { bodies: { block: } }", "must be yes or no"},
        Mistake{kShow, "show: { fingers: { thumb: no } }", "not a finger of the scene"}));

INSTANTIATE_TEST_SUITE_P(
    Look, BrokenSight,
    ::testing::Values(
        Mistake{kShow, "look: [{ body: block }]", "changes nothing"},
        Mistake{kShow, "look: [{ scale: 2 }]", "does not name an object"},
        Mistake{kShow, "look: [{ body: block, target: target, scale: 2 }]",
                "names more than one object"},
        Mistake{kShow, "look: [{ body: blok, scale: 2 }]", "Did you mean block?"},
        Mistake{kShow, "look: [{ finger: thumb, scale: 2 }]", "not a finger of the scene"},
        Mistake{kShow, "look: [{ target: tarket, scale: 2 }]", "Did you mean target?"},
        Mistake{kShow, "look: [{ target: target, colour: red }]", "'red' is not a colour"},
        Mistake{kShow, "look: [{ target: target, colour: \"#12345g\" }]", "is not a colour"},
        Mistake{kShow, "look: [{ target: target, color: red }]", "Did you mean colour?"},
        Mistake{kShow, "look: [{ target: target, scale: 0 }]", "scale"},
        Mistake{"- name: right\n", "- { name: right, look: [{ body: blok, scale: 2 }] }\n",
                "Did you mean block?"}));

INSTANTIATE_TEST_SUITE_P(
    Texts, BrokenSight,
    ::testing::Values(
        Mistake{kMessage, "message: \"Trial {trail_num}\"", "Did you mean trial_num?"},
        Mistake{kMessage, "message: \"Trial {trial_num\"", "is not a valid number in a text"},
        Mistake{kMessage, "message: \"Trial {trial_num:d}\"", "is not a valid number in a text"},
        Mistake{kMessage, "message: \"{trial_num} {trials} {block_num} {blocks} {trials_left}\"",
                "at most 4 are allowed"},
        Mistake{kMessage, "lines: [one, two, three]", "at most 2 are allowed"},
        Mistake{kMessage, "lines: [\"{scoer}\"]", "is not a number that a text can show"},
        Mistake{kMessage, "countdown: 5", "must be yes or no"},
        Mistake{"- { when: time, after_s: 5, outcome: lost, redo: yes }",
                "- { when: key, key: l, outcome: lost, redo: yes }\n      countdown: yes",
                "needs an exit by time"},
        Mistake{"feedback: Good", "feedback: \"{target}\"",
                "is not a number that a text can show"}));

INSTANTIATE_TEST_SUITE_P(
    Delay, BrokenSight,
    ::testing::Values(
        Mistake{kRotation, "visual: { moves: [proxies], delay_ms: 9000 }", "delay_ms"},
        Mistake{kRotation, "visual: { moves: [proxies], delay: 100 }", "needs its unit"},
        Mistake{kRotation, "visual: { moves: [target], delay_ms: 100 }",
                "needs 'proxies' or 'object' among 'moves'"},
        Mistake{kRotation, "visual: { moves: [target], noise_mm: [1, 1, 1] }",
                "needs 'proxies' or 'object' among 'moves'"},
        Mistake{kRotation, "visual: { moves: [proxies], noise_mm: 3 }", "must be three numbers"},
        Mistake{kRotation, "visual: { moves: [proxies], delay_ms: 100, scale: [2, 1, 1] }",
                "about"}));

INSTANTIATE_TEST_SUITE_P(
    Pages, BrokenSight,
    ::testing::Values(
        Mistake{kBlock, "{ name: before, pages: [{ key: y }] }", "neither text nor a picture"},
        Mistake{kBlock, "{ name: before, pages: [{ text: Hello, key: enter }] }",
                "'enter' is not a valid key"},
        Mistake{kBlock, "{ name: before, pages: [{ text: Hello, for_s: -1 }] }", "for_s"},
        Mistake{kBlock, "{ name: before, pages: [{ text: Hello, for: 1 }] }", "needs its unit"},
        Mistake{kBlock, "{ name: before, pages: [{ picture: nowhere.png }] }", "there is no file"},
        Mistake{kBlock, "{ name: before, pages: [{ picture: scene.yaml }] }",
                "is neither a PNG nor a GIF file"},
        Mistake{kBlock, "{ name: before, pages: [{ text: \"{scoer}\" }] }",
                "is not a number that a text can show"},
        Mistake{kBlock, "{ name: before, rest: 30 }", "needs its unit"},
        Mistake{kBlock, "{ name: before, rest_s: -3 }", "rest_s"}));

}  // namespace
}  // namespace dihaptic::task::seen_mistakes_test
