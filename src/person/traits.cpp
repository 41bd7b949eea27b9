#include "person/traits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace dihaptic::person {
namespace {

/// How a trait is spread over people, about its median.
enum class Law {
    normal,      ///< median + spread z
    log_normal,  ///< median exp(spread z)
    logit,       ///< logit(p) = logit(median) + spread z: stays within 0 and 1
    forgetting,  ///< 1 - p is log-normal: a retention near 1
};

constexpr double kFarthest = 2.5;  // SDs from the median: nobody is further off
constexpr double kDegree = std::numbers::pi / 180;

struct Row {
    const char* name;
    double Traits::*trait;
    Law law;
    double median;
    double spread;
};

/// The population. Where a source is given as "textbook", it is an accepted order of magnitude and
/// no figure of one study. Published spreads of adaptation rates are those of fits, whose valley is
/// flat: of their logarithmic spread a third is taken for people's. With it, the mean curve of the
/// population is the published one within 3 degrees.
std::vector<Row> population(Objects objects) {
    const bool real = objects == Objects::real;
    return {
        // Saunders and Knill 2003: 0.12 to 0.16 s to a visible change of arm movement; less the
        // arm's own lag
        {"visual_delay", &Traits::visual_delay, Law::log_normal, 0.11, 0.12},
        {"visual_noise", &Traits::visual_noise, Law::log_normal, 1e-3, 0.2},  // textbook
        {"reaction_time", &Traits::reaction_time, Law::log_normal, 0.28, 0.15},
        {"reaction_noise", &Traits::reaction_noise, Law::log_normal, 0.15, 0.2},
        {"tempo", &Traits::tempo, Law::log_normal, 1, 0.1},
        {"tempo_noise", &Traits::tempo_noise, Law::log_normal, 0.07, 0.2},
        // Jenn's data (TwoRateProprioception): SD of baseline trials
        {"direction_noise", &Traits::direction_noise, Law::log_normal, 4.0 * kDegree, 0.2},
        {"extent_noise", &Traits::extent_noise, Law::log_normal, 0.04, 0.2},
        // Saunders and Knill 2003: partial correction
        {"online_correction", &Traits::online_correction, Law::logit, 0.45, 0.3},

        // TwoRateProprioception: group fit Ls .029, Lf .24, Rs .9987, Rf .66; of 32 people, median
        // and quartiles Ls .033 [.026, .056], Lf .24 [.17, .49], Rs .9995 [.991, 1], Rf .64 [.54,
        // .73]
        {"fast_retention", &Traits::fast_retention, Law::logit, 0.62, 0.2},
        {"fast_learning", &Traits::fast_learning, Law::logit, 0.26, 0.4},
        {"slow_retention", &Traits::slow_retention, Law::forgetting, 0.999, 0.7},
        {"slow_learning", &Traits::slow_learning, Law::log_normal, 0.031, 0.2},
        // 30 to 40 degrees: textbook
        {"generalisation", &Traits::generalisation, Law::log_normal, 35 * kDegree, 0.1},

        // Krakauer 2000: gains take fewer reaches than rotations, and are alike in all directions;
        // the figures are estimates
        {"gain_retention", &Traits::gain_retention, Law::logit, 0.98, 0.3},
        {"gain_learning", &Traits::gain_learning, Law::logit, 0.25, 0.3},

        // Westling and Johansson 1984: margins of 10 to 40 % of classic weights; Kinoshita's group:
        // 45 % at 200 g. Through devices more (EMBC 2022, no figure)
        {"safety_margin", &Traits::safety_margin, Law::logit, real ? 0.38 : 0.5, 0.15},
        {"least_grip", &Traits::least_grip, Law::log_normal, 0.4,
         0.2},  // Hiramatsu 2015: below 30 g
        // Johansson and Westling 1984: 1.1 to 1.4; 50 to 150 ms; load phases of 150 to 400 ms
        {"peak_grip", &Traits::peak_grip, Law::normal, 1.25, 0.06},
        {"preload_time", &Traits::preload_time, Law::log_normal, 0.085, 0.2},
        {"load_time", &Traits::load_time, Law::log_normal, 0.16, 0.12},
        {"load_time_rise", &Traits::load_time_rise, Law::log_normal, 0.028, 0.1},
        // Cole and Abbs 1988: 60 to 90 ms after a load; Johansson and Westling 1984: 65 to 75 ms
        // after a slip
        {"reflex_latency", &Traits::reflex_latency, Law::log_normal, 0.075, 0.08},
        {"reflex_noise", &Traits::reflex_noise, Law::log_normal, 0.004, 0.2},
        // the last lift rules (Neuropsychologia 2008); more trials with devices (EMBC 2022)
        {"weight_learning", &Traits::weight_learning, Law::logit, real ? 0.8 : 0.5, 0.3},
        {"friction_error", &Traits::friction_error, Law::log_normal, real ? 0.05 : 0.1, 0.2},
        // Delhaye 2024: grip has adapted 0.37 s after contact, strain tells 0.1 s before; a device
        // has none
        {"skin_time", &Traits::skin_time, Law::log_normal, real ? 0.15 : 0, 0.15},
        // Ingram et al. 2011: in a few trials, single-rate
        {"mass_retention", &Traits::mass_retention, Law::forgetting, 0.97, 0.3},
        {"mass_learning", &Traits::mass_learning, Law::logit, real ? 0.4 : 0.25, 0.3},

        // Burns and Brooks 2006: faster hands are tolerated more than slower ones; their size and
        // the SD: textbook
        {"answer_bias", &Traits::answer_bias, Law::normal, 0.02, 0.02},
        {"answer_sd", &Traits::answer_sd, Law::log_normal, 0.12, 0.25},
        {"answer_lapse", &Traits::answer_lapse, Law::log_normal, 0.015, 0.4},  // 0 to 0.05

        // textbook
        {"hesitation_rate", &Traits::hesitation_rate, Law::log_normal, 0.01, 0.5},
        {"hesitation_time", &Traits::hesitation_time, Law::log_normal, 0.6, 0.3},
        {"slip_rate", &Traits::slip_rate, Law::log_normal, 0.01, 0.5},
        {"give_up_rate", &Traits::give_up_rate, Law::log_normal, 0.002, 0.5},
    };
}

double drawn(const Row& row, double z) {
    switch (row.law) {
        case Law::normal:
            return row.median + row.spread * z;
        case Law::log_normal:
            return row.median * std::exp(row.spread * z);
        case Law::logit:
            return 1 / (1 + (1 / row.median - 1) * std::exp(-row.spread * z));
        case Law::forgetting:
            return 1 - (1 - row.median) * std::exp(-row.spread * z);
    }
    return row.median;
}

}  // namespace

Traits median_person(Objects objects) {
    Traits out;
    out.objects = objects;
    for (const Row& row : population(objects)) out.*row.trait = row.median;
    for (double Traits::*noise :
         {&Traits::visual_noise, &Traits::reaction_noise, &Traits::tempo_noise,
          &Traits::direction_noise, &Traits::extent_noise, &Traits::reflex_noise,
          &Traits::friction_error, &Traits::hesitation_rate, &Traits::slip_rate,
          &Traits::give_up_rate}) {
        out.*noise = 0;
    }
    return out;
}

Traits draw_person(Objects objects, uint64_t seed, const std::string& id) {
    Traits out;
    out.id = id;
    out.objects = objects;
    for (const Row& row : population(objects)) {
        Random random(seed, fmt::format("person {}, {}", id, row.name));
        out.*row.trait = drawn(row, std::clamp(random.normal(), -kFarthest, kFarthest));
    }
    return out;
}

}  // namespace dihaptic::person
