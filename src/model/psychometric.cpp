#include "model/psychometric.h"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "base/unmeasured.h"

namespace dihaptic::model {
namespace {

double sigmoid_at(const Psychometric& f, double x) {
    switch (f.sigmoid) {
        case Sigmoid::normal:
            return 0.5 * std::erfc((f.threshold - x) / (f.shape * std::numbers::sqrt2));
        case Sigmoid::logistic:
            return 1 / (1 + std::exp((f.threshold - x) / f.shape));
        case Sigmoid::weibull:
            return x <= 0 ? 0 : -std::expm1(-std::pow(x / f.threshold, f.shape));
        case Sigmoid::weibull_log10:
            return -std::expm1(-std::pow(10, f.shape * (x - f.threshold)));
    }
    return kUnmeasured;
}

/// Returns the level at which the sigmoid equals F, where F is in (0, 1).
double sigmoid_inverse(const Psychometric& f, double F) {
    switch (f.sigmoid) {
        case Sigmoid::normal:
            return f.threshold - f.shape * std::numbers::sqrt2 * boost::math::erfc_inv(2 * F);
        case Sigmoid::logistic:
            return f.threshold + f.shape * std::log(F / (1 - F));
        case Sigmoid::weibull:
            return f.threshold * std::pow(-std::log1p(-F), 1 / f.shape);
        case Sigmoid::weibull_log10:
            return f.threshold + std::log10(-std::log1p(-F)) / f.shape;
    }
    return kUnmeasured;
}

}  // namespace

double Psychometric::probability(double level) const {
    return guess + (1 - guess - lapse) * sigmoid_at(*this, level);
}

double Psychometric::level(double probability) const {
    const double F = (probability - guess) / (1 - guess - lapse);
    if (!(F > 0 && F < 1)) return kUnmeasured;
    return sigmoid_inverse(*this, F);
}

double Psychometric::sd() const {
    switch (sigmoid) {
        case Sigmoid::normal:
            return shape;
        case Sigmoid::logistic:
            return shape * std::numbers::pi / std::numbers::sqrt3;
        case Sigmoid::weibull: {
            const double mean = std::tgamma(1 + 1 / shape);
            return threshold * std::sqrt(std::tgamma(1 + 2 / shape) - mean * mean);
        }
        case Sigmoid::weibull_log10:
            // the logarithm of an exponential variable has a standard deviation of pi / sqrt 6
            return std::numbers::pi / (std::sqrt(6.0) * std::numbers::ln10 * shape);
    }
    return kUnmeasured;
}

}  // namespace dihaptic::model
