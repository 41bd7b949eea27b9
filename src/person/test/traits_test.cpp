#include "person/traits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/field_reader.h"
#include "base/field_writer.h"

namespace dihaptic::person {
namespace {

TEST(Traits, OfAPersonAreTheSameWhoeverElseIsDrawn) {
    const auto text = [](const Traits& traits) { return to_yaml(write_fields(traits)); };
    const std::string one = text(draw_person(Objects::device, 7, "S07"));
    draw_person(Objects::device, 7, "S06");
    EXPECT_EQ(text(draw_person(Objects::device, 7, "S07")), one);
    EXPECT_NE(text(draw_person(Objects::device, 7, "S08")), one);
    EXPECT_NE(text(draw_person(Objects::device, 8, "S07")), one);
}

TEST(Traits, AreWithinTheirBoundsAndAroundTheMedian) {
    for (const Objects objects : {Objects::real, Objects::device}) {
        const Traits median = median_person(objects);
        std::vector<double> learning;
        std::vector<double> margin;
        for (int i = 0; i < 400; ++i) {
            Traits traits = draw_person(objects, 1, std::to_string(i));
            // written and read again: every bound is checked
            Diagnostics diagnostics;
            Traits read;
            read_fields(read, write_fields(traits), diagnostics);
            diagnostics.throw_if_errors();
            EXPECT_EQ(read.slow_retention, traits.slow_retention);
            EXPECT_LT(traits.fast_retention, traits.slow_retention);
            EXPECT_GT(traits.fast_learning, traits.slow_learning);
            EXPECT_GT(traits.reflex_latency, 0.06);  // Cole and Abbs 1988
            EXPECT_LT(traits.reflex_latency, 0.092);
            learning.push_back(traits.slow_learning);
            margin.push_back(traits.safety_margin);
        }
        const auto middle = [](std::vector<double>& v) {
            std::nth_element(v.begin(), v.begin() + 200, v.end());
            return v[200];
        };
        EXPECT_NEAR(middle(learning), median.slow_learning, 0.03 * median.slow_learning);
        EXPECT_NEAR(middle(margin), median.safety_margin, 0.01);
    }
}

TEST(Traits, GripHarderAndLearnWeightsMoreSlowlyThroughADevice) {
    const Traits real = median_person(Objects::real);
    const Traits device = median_person(Objects::device);
    EXPECT_GT(device.safety_margin, real.safety_margin);
    EXPECT_LT(device.weight_learning, real.weight_learning);
}

TEST(Traits, AveragedOverAPopulationAdaptAsPeopleDid) {
    // human means of TwoRateProprioception; what is mended within a reach is 0.1 of the error there
    std::vector<model::AdaptationTrial> trials(64);
    trials.insert(trials.end(), 160, {30, false});
    trials.insert(trials.end(), 16, {-30, false});
    trials.insert(trials.end(), 48, {0, true});
    std::vector<double> mean(trials.size(), 0);
    constexpr int kPeople = 300;
    for (int i = 0; i < kPeople; ++i) {
        const Traits traits = draw_person(Objects::device, 1, std::to_string(i));
        const auto x = model::compensation(traits.rotation(), trials);
        for (size_t n = 0; n < x.size(); ++n)
            mean[n] += (x[n] + 0.1 * model::adaptation_error(trials[n], x[n])) / kPeople;
    }
    const auto over = [&](size_t from, size_t to) {
        double sum = 0;
        for (size_t n = from; n < to; ++n) sum += mean[n];
        return sum / static_cast<double>(to - from);
    };
    EXPECT_NEAR(mean[64], 3.5, 3);
    EXPECT_NEAR(mean[64 + 6], 17.6, 3);
    EXPECT_NEAR(mean[64 + 36], 24.2, 3);
    EXPECT_NEAR(over(192, 224), 26.8, 3);
    EXPECT_NEAR(mean[239], -5.7, 3);
    EXPECT_NEAR(mean[240 + 5], 11.5, 3);
    EXPECT_NEAR(over(256, 288), 11.1, 3);
}

}  // namespace
}  // namespace dihaptic::person
