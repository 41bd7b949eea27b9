#include "analysis/fits/two_rate_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::analysis {
namespace {

using model::AdaptationTrial;
using model::TwoRate;

using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;

enum Parameter { kRetentionFast, kLearningFast, kRetentionSlow, kLearningSlow, kParameters };

constexpr int kFree = -1;  // no parameter is held fixed

TwoRate rates_of(const Vec4& p) {
    return {{p[kRetentionFast], p[kLearningFast]}, {p[kRetentionSlow], p[kLearningSlow]}};
}

Vec4 parameters_of(const TwoRate& rates) {
    return {rates.fast.retention, rates.fast.learning, rates.slow.retention, rates.slow.learning};
}

/// The measured trials, and the residuals of the model in these trials.
struct Data {
    std::span<const double> measured;
    std::span<const AdaptationTrial> trials;

    double squares(const Vec4& p) const {
        double fast = 0, slow = 0, sum = 0;
        for (size_t n = 0; n < trials.size(); ++n) {
            const double x = fast + slow;
            if (!std::isnan(measured[n])) sum += (measured[n] - x) * (measured[n] - x);
            const double e = model::adaptation_error(trials[n], x);
            fast = p[kRetentionFast] * fast + p[kLearningFast] * e;
            slow = p[kRetentionSlow] * slow + p[kLearningSlow] * e;
        }
        return std::isfinite(sum) ? sum : std::numeric_limits<double>::max();
    }

    /// Computes half the gradient of the sum of squares, and half of its Gauss-Newton approximation
    /// of the curvature. The derivatives d of both states follow from x(n+1) = A x(n) + B e(n),
    /// with de = -dx.
    void slope(const Vec4& p, Vec4& gradient, Mat4& curvature) const {
        double fast = 0, slow = 0;
        Vec4 d_fast = Vec4::Zero(), d_slow = Vec4::Zero();
        gradient.setZero();
        curvature.setZero();
        for (size_t n = 0; n < trials.size(); ++n) {
            const double x = fast + slow;
            const Vec4 dx = d_fast + d_slow;
            if (!std::isnan(measured[n])) {
                gradient += (x - measured[n]) * dx;
                curvature += dx * dx.transpose();
            }
            const double e = model::adaptation_error(trials[n], x);
            const double seen = trials[n].clamp ? 0 : 1;
            d_fast = p[kRetentionFast] * d_fast - p[kLearningFast] * seen * dx;
            d_slow = p[kRetentionSlow] * d_slow - p[kLearningSlow] * seen * dx;
            d_fast[kRetentionFast] += fast;
            d_fast[kLearningFast] += e;
            d_slow[kRetentionSlow] += slow;
            d_slow[kLearningSlow] += e;
            fast = p[kRetentionFast] * fast + p[kLearningFast] * e;
            slow = p[kRetentionSlow] * slow + p[kLearningSlow] * e;
        }
    }
};

/// Maps the parameters to a point z of the unit cube, where the order of the parameters is no
/// longer a constraint. Each pair has low <= high (retention: fast, slow; learning: slow, fast):
///
///     both free        high = z_high            low = high z_low
///     low held at v    high = v + (1 - v) z_high
///     high held at v                            low = v z_low
///
/// The z of a held parameter is meaningless.
class Cube {
  public:
    explicit Cube(int held = kFree, double value = 0) : held_(held), value_(value) {}

    Vec4 parameters(const Vec4& z) const {
        Vec4 p;
        for (const Pair& pair : kPairs) {
            if (held_ == pair.low) {
                p[pair.low] = value_;
                p[pair.high] = value_ + (1 - value_) * z[pair.high];
            } else {
                p[pair.high] = held_ == pair.high ? value_ : z[pair.high];
                p[pair.low] = p[pair.high] * z[pair.low];
            }
        }
        return p;
    }

    /// The inverse of parameters(). Points outside the cube are clamped to it.
    Vec4 point(const Vec4& p) const {
        Vec4 z;
        for (const Pair& pair : kPairs) {
            const double low = held_ == pair.low ? value_ : p[pair.low];
            const double high = held_ == pair.high ? value_ : p[pair.high];
            z[pair.low] = high > 0 ? low / high : 0;
            z[pair.high] = high;
            if (held_ == pair.low) z[pair.high] = low < 1 ? (high - low) / (1 - low) : 0;
        }
        return z.cwiseMax(0).cwiseMin(1);
    }

    /// Returns the derivative of the parameters p with respect to z, dp / dz.
    Mat4 derivative(const Vec4& z) const {
        Mat4 d = Mat4::Zero();
        for (const Pair& pair : kPairs) {
            if (held_ == pair.low) {
                d(pair.high, pair.high) = 1 - value_;
                continue;
            }
            const double high = held_ == pair.high ? value_ : z[pair.high];
            d(pair.low, pair.low) = high;
            if (held_ == pair.high) continue;
            d(pair.high, pair.high) = 1;
            d(pair.low, pair.high) = z[pair.low];
        }
        return d;
    }

    bool is_held(int i) const { return i == held_; }

  private:
    struct Pair {
        int low, high;
    };
    static constexpr std::array<Pair, 2> kPairs = {
        {{kRetentionFast, kRetentionSlow}, {kLearningSlow, kLearningFast}}};
    int held_;
    double value_;
};

struct Found {
    Vec4 p;
    double squares;
};

/// Runs Levenberg-Marquardt within the cube: a point on a face of the cube stays on that face if it
/// is pulled outward.
Found descend(const Data& data, const Cube& cube, const Vec4& start, int steps) {
    Vec4 z = cube.point(start);
    Found best{cube.parameters(z), 0};
    best.squares = data.squares(best.p);
    double damping = 1e-3;
    Vec4 gradient;
    Mat4 curvature;
    for (int step = 0; step < steps; ++step) {
        data.slope(best.p, gradient, curvature);
        const Mat4 d = cube.derivative(z);
        gradient = d.transpose() * gradient;
        curvature = d.transpose() * curvature * d;
        for (int i = 0; i < kParameters; ++i) {
            const bool stays = (z[i] <= 0 && gradient[i] > 0) || (z[i] >= 1 && gradient[i] < 0) ||
                               cube.is_held(i) || curvature(i, i) <= 0;
            if (!stays) continue;
            curvature.row(i).setZero();
            curvature.col(i).setZero();
            curvature(i, i) = 1;
            gradient[i] = 0;
        }
        bool better = false;
        const double before = best.squares;
        while (!better && damping < 1e12) {
            Mat4 damped = curvature;
            damped.diagonal() *= 1 + damping;
            const Vec4 next = (z - damped.ldlt().solve(gradient)).cwiseMax(0).cwiseMin(1);
            const Vec4 p = cube.parameters(next);
            const double squares = data.squares(p);
            better = squares < best.squares;
            if (better) {
                z = next;
                best = {p, squares};
            }
            damping *= better ? 0.2 : 5;
        }
        damping = std::max(damping, 1e-10);
        if (!better || before - best.squares < 1e-13 * before) break;
    }
    return best;
}

constexpr size_t kRatesEach = 77;  // number of pairs of learning rates per pair of retentions

/// Returns points that cover the whole parameter space, more densely where people's parameters lie.
/// The fractions forgotten and learned per trial span several powers of ten.
std::vector<Vec4> lattice() {
    constexpr double kSlow[] = {0, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 0.7};  // 1 - A_slow
    constexpr double kFast[] = {0, 0.2, 0.4, 0.6, 0.75, 0.88, 0.96, 1};           // A_fast / A_slow
    constexpr double kBFast[] = {1e-4, 1e-3, 0.005, 0.02, 0.05, 0.1, 0.2, 0.35, 0.55, 0.8, 1};
    constexpr double kBSlow[] = {0, 0.02, 0.06, 0.15, 0.35, 0.7, 1};  // B_slow / B_fast
    static_assert(std::size(kBFast) * std::size(kBSlow) == kRatesEach);
    std::vector<Vec4> out;
    for (const double slow : kSlow)
        for (const double fast : kFast)
            for (const double b_fast : kBFast)
                for (const double b_slow : kBSlow)
                    out.emplace_back((1 - slow) * fast, b_fast, 1 - slow, b_fast * b_slow);
    return out;
}

// The search starts from the best points of the lattice and from the best point for each pair of
// retentions: if many lattice points are good, the lowest minimum might not be near any of the best
// ones.
constexpr size_t kScouts = 48;
constexpr int kScoutSteps = 12;   // number of steps for each scout
constexpr size_t kPolished = 12;  // number of best scouts, which continue for kPolishingSteps
constexpr int kPolishingSteps = 400;
constexpr double kSamePlace = 1e-3;  // minima that are no further apart than this count as one

/// Returns the minima, lowest first. Several are kept, because a different one may be lowest when a
/// parameter is held fixed.
std::vector<Found> minima(const Data& data) {
    static const std::vector<Vec4> points = lattice();
    std::vector<Found> found;
    found.reserve(points.size());
    for (const Vec4& p : points) found.push_back({p, data.squares(p)});
    const auto less = [](const Found& a, const Found& b) { return a.squares < b.squares; };
    const auto keep_best = [&](size_t count) {
        count = std::min(count, found.size());
        std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
                          found.end(), less);
        found.resize(count);
    };
    std::vector<Found> of_each;
    for (auto first = found.begin(); first != found.end(); first += kRatesEach)
        of_each.push_back(*std::min_element(first, first + kRatesEach, less));
    keep_best(kScouts);
    found.insert(found.end(), of_each.begin(), of_each.end());
    for (Found& f : found) f = descend(data, Cube(), f.p, kScoutSteps);
    keep_best(kPolished);
    for (Found& f : found) f = descend(data, Cube(), f.p, kPolishingSteps);
    keep_best(kPolished);
    std::vector<Found> different;
    for (const Found& f : found) {
        const bool known = std::any_of(different.begin(), different.end(), [&](const Found& other) {
            return (f.p - other.p).cwiseAbs().maxCoeff() < kSamePlace;
        });
        if (!known) different.push_back(f);
    }
    return different;
}

/// Returns the lowest sum of squares with one parameter held at v, searching from every minimum.
double profile(const Data& data, const std::vector<Found>& minima, int parameter, double v) {
    double least = std::numeric_limits<double>::max();
    for (const Found& minimum : minima)
        least =
            std::min(least, descend(data, Cube(parameter, v), minimum.p, kPolishingSteps).squares);
    return least;
}

Interval interval(const Data& data, const std::vector<Found>& minima, int parameter, int count) {
    const Found& best = minima.front();
    // noise-free data have no residuals, and the limit would be 0
    const double limit =
        std::max(best.squares, 1e-20) * std::exp(kChiSquared95 / (count - kParameters));
    return profile_interval([&](double v) { return profile(data, minima, parameter, v); },
                            best.p[parameter], {0, 1}, limit);
}

int count_of(std::span<const double> measured) {
    return static_cast<int>(
        std::count_if(measured.begin(), measured.end(), [](double y) { return !std::isnan(y); }));
}

}  // namespace

TwoRateFit fit_two_rate(std::span<const double> measured, std::span<const AdaptationTrial> trials) {
    check_numbers(measured, trials);
    const int count = count_of(measured);
    if (count <= kParameters)
        throw Error("too few trials were measured to fit a curve",
                    "measure more trials than the model has parameters");
    const Data data{measured, trials};
    const std::vector<Found> all = minima(data);
    const Found& best = all.front();
    TwoRateFit fit;
    fit.rates = rates_of(best.p);
    fit.predicted = compensation(fit.rates, trials);
    fit.mean_square = best.squares / count;
    fit.residual_sd = std::sqrt(best.squares / (count - kParameters));
    fit.retention_fast = interval(data, all, kRetentionFast, count);
    fit.learning_fast = interval(data, all, kLearningFast, count);
    fit.retention_slow = interval(data, all, kRetentionSlow, count);
    fit.learning_slow = interval(data, all, kLearningSlow, count);
    return fit;
}

double squares_downhill(std::span<const double> measured, std::span<const AdaptationTrial> trials,
                        const TwoRate& start) {
    check_numbers(measured, trials);
    return descend({measured, trials}, Cube(), parameters_of(start), kPolishingSteps).squares;
}

}  // namespace dihaptic::analysis
