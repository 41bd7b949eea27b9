#include "base/number.h"
#include "person/population.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/field_reader.h"
#include "base/field_writer.h"

namespace dihaptic::person::traits_test {
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
            Traits traits = draw_person(objects, 1, number_text(i));
            // reading the written traits checks every bound
            Diagnostics diagnostics;
            Traits read;
            read_fields(read, write_fields(traits), diagnostics);
            diagnostics.throw_if_errors();
            EXPECT_EQ(read.slow_retention, traits.slow_retention);
            EXPECT_GT(traits.reflex_latency, 0.06);  // according to Cole and Abbs (1988)
            EXPECT_LT(traits.reflex_latency, 0.092);
            learning.push_back(traits.slow_learning);
            margin.push_back(traits.safety_margin);
        }
        const auto middle = [](std::vector<double>& v) {
            std::nth_element(v.begin(), v.begin() + 200, v.end());
            return v[200];
        };
        // with 400 people and a spread of 0.52, the median has a standard error of 3 %
        EXPECT_NEAR(middle(learning), median.slow_learning, 0.08 * median.slow_learning);
        EXPECT_LT(median.fast_retention, median.slow_retention);
        EXPECT_GT(median.fast_learning, median.slow_learning);
        EXPECT_NEAR(middle(margin), median.safety_margin, 0.01);
    }
}

TEST(Traits, GripHarderAndLearnWeightsMoreSlowlyThroughADevice) {
    const Traits real = median_person(Objects::real);
    const Traits device = median_person(Objects::device);
    EXPECT_GT(device.safety_margin, real.safety_margin);
    EXPECT_LT(device.weight_learning, real.weight_learning);
}

}  // namespace
}  // namespace dihaptic::person::traits_test
