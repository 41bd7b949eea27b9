// Compares simulated people's force channels with those of people in a field of 6 N*s/m, without
// delay and 70 ms late. The force processes of the shipped population were calibrated to the means
// of these ten people, and the arm's mass to their scatter, so that this is no test of a
// prediction.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <numeric>

#include "base/table.h"
#include "person/test/sitting.h"

namespace dihaptic::person {
namespace {

constexpr int kSubjects = 20;
constexpr size_t kChannels = 45;  // 5 in the baseline, 26 in the field, 14 in the washout

/// Figures of five people (Avraham et al. 2017, own evaluation of the published trials), of the
/// adaptation index in channels.
struct People {
    const char* what;
    const char* delay;
    double scatter;               // SD over the channels of the baseline, within people
    double first, last, last_sd;  // means of the first and last five channels in the field
    double within;                // SD over those last five channels, within people
    std::array<double, 4> decay;  // channels 1, 2, 3 and 5 of the washout
};
constexpr std::array kPeopleOf{
    People{"no delay", "", 0.047, 0.39, 0.79, 0.13, 0.15, {0.42, 0.30, 0.21, 0.05}},
    People{"70 ms", ", delay_ms: 70", 0.046, 0.58, 0.73, 0.10, 0.11, {0.40, 0.21, 0.09, 0.02}}};

using Indices = std::vector<std::array<double, kChannels>>;  // by person

Indices indices(const People& people) {
    Sitting sitting("curl-field");
    sitting.replace("damping_Ns_m: 13 }", fmt::format("damping_Ns_m: 6{} }}", people.delay));
    sitting.replace("duration_s: 0.5, reach: target", "duration_s: 0.4, reach: target");
    sitting.end_with("  blocks:", R"(  blocks:
    - name: baseline
      kind: baseline
      perturb: plane
      repeats: 35
      insert: [{ kind: force_channel, perturb: [plane, channel], count: 5, gap: 6 }]
    - name: field
      kind: perturbed
      perturb: [plane, curl]
      repeats: 182
      insert: [{ kind: force_channel, perturb: [plane, channel], count: 26, gap: 6 }]
    - name: washout
      kind: washout
      perturb: plane
      repeats: 98
      insert: [{ kind: force_channel, perturb: [plane, channel], count: 14, gap: 6 }]
)");
    Indices out;
    for (int i = 1; i <= kSubjects; ++i) {
        session::Plan plan = sitting.plan();
        sit_down(plan, draw_person(Objects::device, 1, fmt::format("sim-{:03d}", i)));
        session::RunOptions options;
        options.out = sitting.folder.file("sessions");
        const CsvFile trials(session::record(plan, options, kGoOn).folder + "/trials.csv");
        out.emplace_back().fill(NAN);
        size_t channel = 0;
        for (size_t row = 0; row < trials.rows(); ++row) {
            if (trials.text(row, "kind") != "force_channel") continue;
            if (trials.text(row, "outcome") != "reached") continue;
            if (channel < kChannels && !trials.text(row, "adaptation_index").empty())
                out.back()[channel] = trials.number(row, "adaptation_index");
            ++channel;
        }
    }
    return out;
}

/// Mean and sum of squares over the channels in [from, to) of one person.
struct Course {
    double mean = 0;
    double variance = 0;
};
Course course(const std::array<double, kChannels>& of, size_t from, size_t to) {
    std::vector<double> x;
    for (size_t i = from; i < to; ++i) {
        if (!std::isnan(of[i])) x.push_back(of[i]);
    }
    Course out;
    for (const double value : x) out.mean += value / static_cast<double>(x.size());
    for (const double value : x)
        out.variance += std::pow(value - out.mean, 2) / static_cast<double>(x.size() - 1);
    return out;
}

struct Over {
    double mean = 0;    // over people
    double sd = 0;      // of people's means
    double within = 0;  // SD over channels, pooled over people
};
Over over(const Indices& all, size_t from, size_t to) {
    Over out;
    const auto n = static_cast<double>(all.size());
    std::vector<double> means;
    for (const auto& person : all) {
        const Course of = course(person, from, to);
        means.push_back(of.mean);
        out.mean += of.mean / n;
        out.within += of.variance / n;
    }
    out.within = std::sqrt(out.within);
    for (const double mean : means) out.sd += std::pow(mean - out.mean, 2) / (n - 1);
    out.sd = std::sqrt(out.sd);
    return out;
}

void expect_ratio(const char* what, double simulated, double real) {
    fmt::print("  {:38s} {:.3f}   people {:.3f}   ratio {:.2f}\n", what, simulated, real,
               simulated / real);
    EXPECT_GE(simulated / real, 0.7) << what;
    EXPECT_LE(simulated / real, 1.4) << what;
}

void expect_near(const char* what, double simulated, double real) {
    fmt::print("  {:38s} {:.2f}    people {:.2f}    off by {:+.2f}\n", what, simulated, real,
               simulated - real);
    EXPECT_NEAR(simulated, real, 0.18) << what;  // people's two groups differ by as much
}

TEST(Channels, OfSimulatedPeopleAreLikeThoseOfPeople) {
    for (const People& people : kPeopleOf) {
        SCOPED_TRACE(people.what);
        fmt::print("{}: {} simulated people, 5 people\n", people.what, kSubjects);
        const Indices all = indices(people);
        expect_ratio("scatter in the baseline", over(all, 0, 5).within, people.scatter);
        expect_ratio("scatter late in the field", over(all, 25, 30).within, people.within);
        expect_ratio("SD over people late in the field", over(all, 25, 30).sd, people.last_sd);
        expect_near("first five channels in the field", over(all, 5, 10).mean, people.first);
        expect_near("last five channels in the field", over(all, 25, 30).mean, people.last);
        for (const size_t i : {0, 1, 2, 4}) {
            std::vector<double> values;
            for (const auto& person : all) {
                if (!std::isnan(person[31 + i])) values.push_back(person[31 + i]);
            }
            const double mean = std::accumulate(values.begin(), values.end(), 0.0) /
                                static_cast<double>(values.size());
            const size_t place = i == 4 ? 3 : i;
            expect_near(fmt::format("channel {} of the washout", i + 1).c_str(), mean,
                        people.decay[place]);
        }
    }
}

}  // namespace
}  // namespace dihaptic::person
