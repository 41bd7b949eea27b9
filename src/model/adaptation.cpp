#include "model/adaptation.h"

namespace dihaptic::model {
namespace {

/// Returns the limit of the process's state when the error is constantly 1.
double gain(const SingleRate& rate) {
    return rate.learning / (1 - rate.retention);
}

bool forgets_nothing(const SingleRate& rate) {
    return rate.retention >= 1 && rate.learning > 0;
}

double closed_loop(double gain) {
    return gain / (1 + gain);
}

}  // namespace

std::vector<double> compensation(const SingleRate& rate, std::span<const AdaptationTrial> trials) {
    std::vector<double> x;
    x.reserve(trials.size());
    double state = 0;
    for (const AdaptationTrial& trial : trials) {
        x.push_back(state);
        state = next(rate, state, adaptation_error(trial, state));
    }
    return x;
}

std::vector<double> compensation(const TwoRate& rates, std::span<const AdaptationTrial> trials) {
    std::vector<double> x;
    x.reserve(trials.size());
    TwoRateState state;
    for (const AdaptationTrial& trial : trials) {
        x.push_back(state.output());
        state = next(rates, state, adaptation_error(trial, state.output()));
    }
    return x;
}

double asymptote(const SingleRate& rate) {
    if (forgets_nothing(rate)) return 1;
    return rate.learning > 0 ? closed_loop(gain(rate)) : 0;
}

double asymptote(const TwoRate& rates) {
    if (forgets_nothing(rates.fast) || forgets_nothing(rates.slow)) return 1;
    double sum = 0;
    for (const SingleRate& rate : {rates.fast, rates.slow})
        if (rate.learning > 0) sum += gain(rate);
    return closed_loop(sum);
}

}  // namespace dihaptic::model
