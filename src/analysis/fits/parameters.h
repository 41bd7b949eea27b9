// Lists the parameters of each fit by the names used in the command `fit` and in the Python
// package.
#pragma once

#include <vector>

#include "analysis/fits/adaptation_fit.h"
#include "analysis/fits/psychometric_fit.h"
#include "analysis/fits/two_rate_fit.h"

namespace dihaptic::analysis {

struct Parameter {
    const char* name;
    double value;
    Interval interval;  ///< 95 %
};
using Parameters = std::vector<Parameter>;

inline Parameters parameters(const TwoRateFit& fit) {
    return {{"retention_slow", fit.rates.slow.retention, fit.retention_slow},
            {"learning_slow", fit.rates.slow.learning, fit.learning_slow},
            {"retention_fast", fit.rates.fast.retention, fit.retention_fast},
            {"learning_fast", fit.rates.fast.learning, fit.learning_fast}};
}

inline Parameters parameters(const SingleRateFit& fit) {
    return {{"retention", fit.rate.retention, fit.retention},
            {"learning", fit.rate.learning, fit.learning}};
}

inline Parameters parameters(const LearningCurveFit& fit) {
    return {{"start", fit.curve.start, fit.start},
            {"asymptote", fit.curve.asymptote, fit.asymptote},
            {"time_constant", fit.curve.time_constant, fit.time_constant}};
}

inline Parameters parameters(const PsychometricFit& fit, const PsychometricIntervals& ends) {
    return {{"threshold", fit.function.threshold, ends.threshold},
            {"shape", fit.function.shape, ends.shape},
            {"lapse", fit.function.lapse, ends.lapse}};
}

}  // namespace dihaptic::analysis
