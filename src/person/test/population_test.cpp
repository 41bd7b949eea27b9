#include "person/population.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "testing/files.h"

namespace dihaptic::person::population_test {
namespace {

/// A population file that is based on the shipped population.
struct File {
    testing::TemporaryFolder folder;
    Population read(const std::string& rest) {
        const std::string base =
            std::filesystem::current_path().string() + "/populations/adults.yaml";
        return read_population(
            folder.write("p.yaml", "title: Mine\nbased_on: " + base + "\n" + rest));
    }
    std::string refused(const std::string& rest) {
        try {
            read(rest);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }
};

TEST(Population, ThatIsShippedIsInItsFile) {
    const Population file = read_population("populations/adults.yaml");
    EXPECT_EQ(file.traits.size(), shipped_population(Objects::device).traits.size());
    const Traits one = draw_person(file, 1, "sim-001");
    EXPECT_EQ(one.slow_learning, draw_person(Objects::device, 1, "sim-001").slow_learning);
    const Population real = read_population("populations/adults-real-objects.yaml");
    EXPECT_EQ(draw_person(real, 1, "sim-001").safety_margin,
              draw_person(Objects::real, 1, "sim-001").safety_margin);
    // people have the same values of traits in which the two populations do not differ
    EXPECT_EQ(draw_person(real, 1, "sim-001").slow_learning, one.slow_learning);
    for (const TraitSpread& trait : file.traits) EXPECT_NE(trait.source, "") << trait.trait;
}

TEST(Population, HasGroupsInTurnThatDifferInWhatTheyName) {
    const Population population = File().read(R"(groups:
  - { name: control }
  - name: patients
    traits:
      - { trait: slow_retention, median: 0.95, spread: 0 }
)");
    const Traits control = draw_person(population, 1, "sim-001");
    const Traits patient = draw_person(population, 1, "sim-002");
    EXPECT_EQ(control.group, "control");
    EXPECT_EQ(patient.group, "patients");
    EXPECT_EQ(patient.population, "Mine");
    EXPECT_NEAR(patient.slow_retention, 0.95, 1e-12);
    EXPECT_EQ(median_person(population, "patients").slow_retention, 0.95);
    // groups do not change which people are drawn
    EXPECT_EQ(patient.tempo, draw_person(Objects::device, 1, "sim-002").tempo);
    EXPECT_EQ(control.slow_retention, draw_person(Objects::device, 1, "sim-001").slow_retention);
}

TEST(Population, HasLaboratoriesInTurnWhoseMediansDiffer) {
    const std::string traits = R"(traits:
  - { trait: tempo, law: log_normal, median: 1, spread: 0.1, between_laboratories: 0.4 }
  - { trait: tempo_noise, law: log_normal, median: 0.07, spread: 0.2, between_laboratories: 0.3 }
correlations:
  - { traits: [tempo, tempo_noise], r: 0, between_laboratories: 0.9 }
)";
    const Population one = File().read(traits);
    const Population many = File().read("laboratories: 400\n" + traits);
    std::vector<double> tempo;  // of laboratories, as the log of their ratio to the median one
    std::vector<double> noise;
    for (int i = 1; i <= 400; ++i) {
        const std::string id = "sim-" + number_text(i);
        const Traits here = draw_person(many, 1, id);
        const Traits median = draw_person(one, 1, id);
        EXPECT_EQ(here.laboratory, i);
        EXPECT_EQ(median.laboratory, 0);
        tempo.push_back(std::log(here.tempo / median.tempo));
        noise.push_back(std::log(here.tempo_noise / median.tempo_noise));
        EXPECT_EQ(here.reaction_time, median.reaction_time);  // no difference is stated
    }
    double xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < tempo.size(); ++i) {
        xx += tempo[i] * tempo[i] / 400;
        yy += noise[i] * noise[i] / 400;
        xy += tempo[i] * noise[i] / 400;
    }
    // the standard error of an SD of 400 values is 3.5 %
    EXPECT_NEAR(std::sqrt(xx), 0.4, 0.05);
    EXPECT_NEAR(std::sqrt(yy), 0.3, 0.04);
    EXPECT_NEAR(xy / std::sqrt(xx * yy), 0.9, 0.03);
    // people of one laboratory are displaced alike
    const Population two = File().read("laboratories: 2\n" + traits);
    const auto shift = [&](const std::string& id) {
        return draw_person(two, 1, id).tempo / draw_person(one, 1, id).tempo;
    };
    EXPECT_NEAR(shift("sim-001"), shift("sim-003"), 1e-12);
    EXPECT_GT(std::abs(shift("sim-001") - shift("sim-002")), 1e-3);
    EXPECT_NE(File()
                  .refused(traits + "  - { traits: [tempo, extent_noise], r: 0, "
                                    "between_laboratories: 0.9 }\n"
                                    "  - { traits: [tempo_noise, extent_noise], r: 0, "
                                    "between_laboratories: -0.9 }\n")
                  .find("contradict each other"),
              std::string::npos);
}

TEST(Population, CountsPeopleWithinTheirGroup) {
    const Population grouped = File().read("groups:\n  - { name: a }\n  - { name: b }\n");
    const Population plain = File().read("");
    std::map<std::string, std::vector<int>> numbers;
    for (const std::string id : {"sim-001", "sim-002", "sim-003", "sim-004", "sim-005"}) {
        numbers[grouped.group_of(id)].push_back(grouped.number_in_group(id));
        numbers["all"].push_back(plain.number_in_group(id));
    }
    EXPECT_EQ(numbers["a"], (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(numbers["b"], (std::vector<int>{1, 2}));
    EXPECT_EQ(numbers["all"], (std::vector<int>{1, 2, 3, 4, 5}));
}

TEST(Population, DrawsWithItsSpreadsAndCorrelations) {
    const Population population = File().read(R"(traits:
  - { trait: direction_noise_deg, law: log_normal, median: 5, spread: 0.3 }
  - { trait: tempo, spread: 0.2 }
correlations:
  - { traits: [direction_noise_deg, tempo], r: 0.6 }
)");
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    constexpr int kPeople = 2000;
    for (int i = 0; i < kPeople; ++i) {
        const Traits traits = draw_person(population, 1, "sim-" + number_text(i));
        const double x = std::log(traits.direction_noise * 180 / M_PI / 5);
        const double y = std::log(traits.tempo);
        a += x / kPeople;
        b += y / kPeople;
        aa += x * x / kPeople;
        bb += y * y / kPeople;
        ab += x * y / kPeople;
    }
    EXPECT_NEAR(a, 0, 0.02);
    EXPECT_NEAR(b, 0, 0.015);
    EXPECT_NEAR(std::sqrt(aa), 0.3, 0.02);
    EXPECT_NEAR(std::sqrt(bb), 0.2, 0.015);
    EXPECT_NEAR(ab / std::sqrt(aa * bb), 0.6, 0.05);
}

TEST(Population, ThatCannotBeIsRefusedWithFileLineAndRemedy) {
    File file;
    EXPECT_NE(
        file.refused("traits:\n  - { trait: slow_learnin, law: normal, median: 1, spread: 0 }\n")
            .find("p.yaml:4: error: slow_learnin"),
        std::string::npos);
    const std::string bounds = file.refused(
        "traits:\n  - { trait: answer_lapse, law: normal, median: 0.2, spread: 0.2 }\n");
    EXPECT_NE(bounds.find("p.yaml:4: error: answer_lapse"), std::string::npos) << bounds;
    EXPECT_NE(file.refused("groups:\n  - { name: a, traits: [{ trait: tempoo, median: 1 }] }\n")
                  .find("is not a trait of this population"),
              std::string::npos);
    EXPECT_NE(file.refused(R"(correlations:
  - { traits: [tempo, slow_learning], r: 0.9 }
  - { traits: [tempo, fast_learning], r: 0.9 }
  - { traits: [slow_learning, fast_learning], r: -0.9 }
)")
                  .find("contradict each other"),
              std::string::npos);
    EXPECT_NE(
        file.refused("correlations: [{ traits: [tempo, tempo], r: 0.5 }]\n").find("are not two"),
        std::string::npos);
    EXPECT_NE(file.refused(R"(correlations:
  - { traits: [tempo, slow_learning], r: 0.5 }
  - { traits: [slow_learning, tempo], r: 0.1 }
)")
                  .find("p.yaml:5: error: traits: already have a correlation"),
              std::string::npos);
    try {
        read_population(file.folder.write("alone.yaml", "title: Alone\n"));
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("slow_learning: is missing"), std::string::npos);
    }
}

TEST(Population, IsNotBasedOnItselfByAWayAround) {
    testing::TemporaryFolder folder;
    const std::string a = folder.write("a.yaml", "title: A\nbased_on: b.yaml\n");
    folder.write("b.yaml", "title: B\nbased_on: a.yaml\n");
    try {
        read_population(a);
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("b.yaml:2: error: based_on: leads back"),
                  std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace dihaptic::person::population_test
