// Tests texts that contain numbers, and how objects in a Frame are displayed.
#include "frame/shown_texts.h"

#include <gtest/gtest.h>

#include <limits>

#include "frame/displayed.h"

namespace dihaptic::frame::shown_texts_test {
namespace {

std::string fill(const std::string& text, const std::vector<NumberFrame>& numbers) {
    std::span<const NumberFrame> left = numbers;
    return filled(text, left);
}

TEST(ShownTexts, HaveNumbersWhereTheyNameThem) {
    EXPECT_EQ(fill("Go home", {}), "Go home");
    EXPECT_EQ(fill("{score}", {{12}}), "12");
    EXPECT_EQ(fill("Trial {trial_num} of {trials}!", {{3}, {120}}), "Trial 3 of 120!");
    EXPECT_EQ(fill("{time:.0f} ms, {time:.2f} s", {{249.6}, {0.2496}}), "250 ms, 0.25 s");
    EXPECT_EQ(fill("{gain}", {{1.0 / 3}}), "0.3333");
    EXPECT_EQ(fill("{score}", {{-1e6}}), "-1000000");
    EXPECT_EQ(fill("{time:.1f} s", {{std::numeric_limits<double>::quiet_NaN()}}), "- s");
    EXPECT_EQ(fill("{{score}} is {score}", {{4}}), "{score} is 4");
    EXPECT_EQ(fill("100 %, {a} and {b}", {{1}}), "100 %, 1 and {b}");
}

TEST(ShownTexts, SayWhichOfTheirPlacesAreMalformed) {
    const auto good = placeholders("{a} {b.x} {c_mm:.1f} {{d}}");
    ASSERT_EQ(good.size(), 3u);
    EXPECT_EQ(good[0].name, "a");
    EXPECT_EQ(good[1].name, "b.x");
    EXPECT_EQ(good[2].name, "c_mm");
    EXPECT_EQ(good[2].decimals, 1);
    for (const char* text :
         {"{", "}", "{}", "{a", "a}", "{a:d}", "{a:.f}", "{a:.9f}", "{2}", "{a b}"}) {
        const auto bad = placeholders(text);
        ASSERT_EQ(bad.size(), 1u) << text;
        EXPECT_EQ(bad[0].name, "") << text;
        EXPECT_EQ(fill(text, {}), text);
    }
}

TEST(ShownTexts, AreTheMessageThenTheLinesWithTheirNumbersInTurn) {
    const std::vector<std::string> messages{"Go", "Trial {trial_num}", "{score} points"};
    TaskFrame task;
    EXPECT_TRUE(shown_texts(task, messages).empty());
    task.message = 1;
    task.lines = {{2}, {0}, {7}};
    task.numbers = {{5}, {40}};
    EXPECT_EQ(shown_texts(task, messages),
              (std::vector<std::string>{"Trial 5", "40 points", "Go", "7"}));
    task.message = -1;
    task.numbers = {{41}};
    EXPECT_EQ(shown_texts(task, messages), (std::vector<std::string>{"41 points", "Go", "7"}));
}

TEST(Displayed, IsAsTheFrameSaysOfEachBodyAndProxy) {
    Frame frame;
    frame.bodies.resize(2);
    frame.fingers.resize(2);
    frame.bodies[1].X_WB.p = {0.1, 0, 0};
    frame.fingers[1].p_WP = {0, 0.2, 0};
    frame.fingers[1].p_WH = {0, 0.21, 0};
    EXPECT_TRUE(is_displayed(frame, 0));
    EXPECT_EQ(displayed_size(frame, 1), 1);
    frame.task.looks = {{1, 1, -1, 1}, {3, 0, 0xff0000, 1.5}};
    EXPECT_TRUE(is_displayed(frame, 0));
    EXPECT_FALSE(is_displayed(frame, 1));
    EXPECT_TRUE(is_displayed(frame, proxy_of(frame, 1)));
    EXPECT_EQ(displayed_size(frame, proxy_of(frame, 1)), 1.5);
    EXPECT_EQ(displayed_proxy(frame, 1).p, Vec3(0, 0.2, 0));
    EXPECT_EQ(displayed_handle(frame, 1).p, Vec3(0, 0.21, 0));
    frame.task.displaced = {{1, {Quat::Identity(), {1, 1, 1}}},
                            {3, {Quat::Identity(), {0, 0.4, 0}}}};
    EXPECT_EQ(displayed_body(frame, 1).p, Vec3(1, 1, 1));
    EXPECT_EQ(displayed_body(frame, 0).p, Vec3(0, 0, 0));
    EXPECT_EQ(displayed_proxy(frame, 1).p, Vec3(0, 0.4, 0));
    EXPECT_EQ(displayed_handle(frame, 1).p, Vec3(0, 0.4, 0));
    EXPECT_EQ(mapped_proxy(frame, 1).p, Vec3(0, 0.2, 0));
    EXPECT_EQ(displayed_hand(frame, 2, {9, 9, 9}), Vec3(0, 0.4, 0));
    EXPECT_EQ(displayed_hand(frame, 3, {9, 9, 9}), Vec3(0, 0.2, 0));
}

}  // namespace
}  // namespace dihaptic::frame::shown_texts_test
