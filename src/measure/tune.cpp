#include "measure/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/figure.h"
#include "model/grasp.h"
#include "model/gravity.h"

namespace dihaptic::measure {
namespace {

using model::kGravity;
constexpr double kHandSpread = 3;   // impedance ratio of firm to usual and of usual to loose hand
constexpr double kGripShare = 0.4;  // grip force as a fraction of the weaker device's peak force
/// Grip force, including the weight, as a fraction of the weaker device's continuous force: hot
/// motors get less force, and a hold that shook for this reason could not be made calm by any
/// setting.
constexpr double kGripForLong = 0.8;
constexpr double kNotMargin =
    1.5;  // ratio of the stiffness of TuneResult::stiffer to that of the proposal
constexpr double kAsStiff = 0.95;  // a row with this fraction of the greatest stiffness is stiff
                                   // enough if its damping is lower
constexpr int kBisections = 3;     // number of bisections between two stiffnesses on the map
constexpr std::array kAllBurdens{Burden::none, Burden::delay, Burden::light, Burden::loose,
                                 Burden::firm};

bool dual(const TuneSetup& setup) {
    return setup.settings.coupling.kind == frame::CouplingKind::dual_spring &&
           setup.settings.proxy.kind == scene::ProxyKind::rigid;
}

/// Calls `work(i)` for every i below `count`, on several threads. Calls `done(n)` on this thread,
/// where n is the number of calls that have finished. Each result belongs to its i, so the order of
/// the calls makes no difference.
template <class Work, class Done>
void in_parallel(size_t count, unsigned threads, const std::atomic<bool>& stop, const Work& work,
                 const Done& done) {
    std::atomic<size_t> next{0};
    std::atomic<size_t> ended{0};
    std::atomic<unsigned> running{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto worker = [&] {
        try {
            for (size_t i = next++; i < count && !stop; i = next++) {
                work(i);
                ++ended;
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
        --running;
    };
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    threads = static_cast<unsigned>(std::min<size_t>(threads, count));
    running = threads;
    std::vector<std::thread> pool;
    for (unsigned i = 0; i < threads; ++i) pool.emplace_back(worker);
    while (running > 0) {
        done(ended.load());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (std::thread& thread : pool) thread.join();
    if (failure) std::rethrow_exception(failure);
}

Verdict judge(const TuneSetup& setup, const TunePoint& point, Burden burden) {
    const HoldFigures hold = measure_hold(hold_setup(setup, point, burden));
    double friction = 0;
    for (const rig::Device& device : setup.devices)
        friction = std::max(friction, simulated_options(device).friction);
    // a device's friction absorbs part of the hand's force, whichever way the hand moves
    if (calm_grasp(hold, friction / setup.grip)) return Verdict::calm;
    return hold.held ? Verdict::shaking : Verdict::dropped;
}

/// Judges points: first all points without a burden, then the points that were calm, under each of
/// the burdens.
void judge_all(const TuneSetup& setup, std::vector<TunePoint>& points,
               const std::atomic<bool>& stop, const std::function<void(double)>& share) {
    const auto n = static_cast<double>(points.size());
    in_parallel(
        points.size(), setup.threads, stop,
        [&](size_t i) { points[i].verdicts[Burden::none] = judge(setup, points[i], Burden::none); },
        [&](size_t ended) { share(static_cast<double>(ended) / (n * kBurdens)); });
    std::vector<TunePoint*> calm;
    for (TunePoint& point : points) {
        if (point.calm(Burden::none)) calm.push_back(&point);
    }
    constexpr size_t kOthers = kBurdens - 1;
    const size_t count = calm.size() * kOthers;
    in_parallel(
        count, setup.threads, stop,
        [&](size_t i) {
            TunePoint& point = *calm[i / kOthers];
            const Burden burden = kAllBurdens[1 + i % kOthers];
            point.verdicts[burden] = judge(setup, point, burden);
        },
        [&](size_t ended) {
            share((1 + (kBurdens - 1) * static_cast<double>(ended) / static_cast<double>(count)) /
                  kBurdens);
        });
}

/// Rounds down to two significant digits, as people usually write numbers in files.
double rounded_down(double k) {
    const double unit = std::pow(10, std::floor(std::log10(k)) - 1);
    return std::floor(k / unit * (1 + 1e-12)) * unit;
}

double one_digit_less(double k) {
    return rounded_down(k * 0.99);
}

/// A row of the map that reaches the highest K, with its last good stiffness and its first bad one.
struct Bracket {
    double c;
    double smoothing;
    double of_map;  ///< last good K on the map
    double good;
    double bad;
};
std::vector<Bracket> best_rows(const TuneSetup& setup, const TuneResult& result) {
    std::vector<Bracket> rows;
    for (const double smoothing : setup.smoothing) {
        for (const double c : setup.damping) {
            double good = setup.stiffness.back();
            for (const Burden burden : kAllBurdens)
                good = std::min(good, calm_limit(result, c, smoothing, burden));
            if (good <= 0 || (!rows.empty() && good < rows.front().good)) continue;
            if (!rows.empty() && good > rows.front().good) rows.clear();
            const auto next =
                std::upper_bound(setup.stiffness.begin(), setup.stiffness.end(), good);
            rows.push_back(
                {c, smoothing, good, good, next == setup.stiffness.end() ? good : *next});
        }
    }
    return rows;
}

/// Returns a function that reports the progress of one part as progress between `from` and `to` of
/// the whole.
std::function<void(double)> part_of(const Progress& progress, const char* what, double from,
                                    double to) {
    return [&progress, what, from, to](double share) {
        if (progress) progress(what, from + share * (to - from));
    };
}

/// Narrows the gap between the last good stiffness and the first bad stiffness of each row.
void bisect(const TuneSetup& setup, std::vector<Bracket>& rows, const std::atomic<bool>& stop,
            const Progress& progress) {
    for (int i = 0; i < kBisections && !stop; ++i) {
        std::vector<TunePoint> middle;
        for (const Bracket& row : rows) {
            if (row.bad > row.good)
                middle.push_back({std::sqrt(row.good * row.bad), row.c, row.smoothing, {}});
        }
        judge_all(setup, middle, stop,
                  part_of(progress, "the proposal", 0.85 + 0.03 * i, 0.88 + 0.03 * i));
        auto judged = middle.begin();
        for (Bracket& row : rows) {
            if (row.bad <= row.good) continue;
            (judged->calm_with_margin() ? row.good : row.bad) = judged->k;
            ++judged;
        }
    }
}

/// Returns the row with the least damping out of those that are about as stiff as the stiffest row,
/// because damping is felt at every touch. Damping must increase from row to row.
const Bracket& least_damped(const std::vector<Bracket>& rows) {
    const double stiffest =
        std::max_element(rows.begin(), rows.end(), [](const Bracket& a, const Bracket& b) {
            return a.good < b.good;
        })->good;
    return *std::find_if(rows.begin(), rows.end(),
                         [&](const Bracket& row) { return row.good >= kAsStiff * stiffest; });
}

/// Returns the highest K that is calm with margin, or at least the K that is calm on the map.
/// Searches downward in steps of the second digit, because calm and shaking values may alternate.
TunePoint stiffest_calm(const TuneSetup& setup, const Bracket& row, const std::atomic<bool>& stop,
                        const Progress& progress) {
    const auto judged = [&](double k) {
        std::vector<TunePoint> point{{k, row.c, row.smoothing, {}}};
        judge_all(setup, point, stop, part_of(progress, "the proposal", 0.94, 0.97));
        return point.front();
    };
    for (double k = rounded_down(row.good); k > row.of_map && !stop; k = one_digit_less(k)) {
        const TunePoint point = judged(k);
        if (point.calm_with_margin()) return point;
    }
    return judged(row.of_map);
}

}  // namespace

bool TunePoint::calm_with_margin() const {
    return std::all_of(kAllBurdens.begin(), kAllBurdens.end(), [&](Burden b) { return calm(b); });
}

TuneSetup tune_setup(const rig::Rig& rig, const std::vector<std::string>& fingers,
                     const frame::Settings& settings, const hand::Impedance& hand) {
    if (fingers.size() < 2) {
        throw Error(
            fmt::format("tuning holds a block between two fingers, but the scene has only {}",
                        fingers.empty() ? "none" : fingers.front()),
            "Name a scene or an experiment with two fingers, on a rig with two devices.");
    }
    TuneSetup out;
    out.settings = settings;
    out.hand = hand;
    double peak = std::numeric_limits<double>::infinity();
    double for_long = peak;
    for (size_t i = 0; i < 2; ++i) {
        const rig::Device& device = rig::device_of(rig, fingers[i]);
        if (device.backend != "simulated") {
            throw Error(device.place, "backend",
                        fmt::format("'{}' cannot be tuned: settings are tried on simulated "
                                    "devices, before a person holds the real ones",
                                    device.backend),
                        "Write a rig with 'backend: simulated' and the device's mass_g, "
                        "peak_force_N, position_step_mm, friction_N and delay_ticks.");
        }
        const auto options = simulated_options(device);
        peak = std::min(peak, options.peak_force);
        for_long = std::min(for_long, options.continuous_force.value_or(for_long));
        out.devices.push_back(device);
    }
    out.grip = std::min(kGripShare * std::min(peak, settings.safety.max_force.value_or(peak)),
                        kGripForLong * for_long);
    out.stiffness = {200,  260,  340,  440,  570,  740,  970,  1300,
                     1600, 2100, 2800, 3600, 4700, 6100, 7900, 10000};
    out.damping = {0, 0.25, 0.5, 1, 1.5, 2, 3, 4};
    out.smoothing = {settings.coupling.smoothing};
    if (dual(out)) out.smoothing = {0.1, 0.2, 0.4, 0.7, 1};
    return out;
}

BenchSetup hold_setup(const TuneSetup& setup, const TunePoint& point, Burden burden) {
    BenchSetup out;
    out.settings = setup.settings;
    out.settings.coupling.stiffness = point.k;
    out.settings.coupling.damping = point.c;
    out.settings.coupling.smoothing = point.smoothing;
    out.fingering = Fingering::offset;
    out.devices = setup.devices;
    out.impedance = setup.hand;
    if (burden == Burden::delay) out.row = Row::delay;
    if (burden == Burden::light) out.mass = 0.01;
    if (burden == Burden::loose || burden == Burden::firm) {
        const double factor = burden == Burden::firm ? kHandSpread : 1 / kHandSpread;
        out.impedance.stiffness *= factor;
        out.impedance.damping *= factor;
        out.impedance.stiffness_per_force *= factor;
    }
    // hands of any stiffness use the same grip force, and lift to the same height
    const double k_hand = out.impedance.stiffness + out.impedance.stiffness_per_force * setup.grip;
    out.squeeze = model::series_spring_stretch(setup.grip, k_hand, point.k);
    out.lift += model::series_spring_stretch(out.mass * kGravity / 2, k_hand, point.k);
    return out;
}

double calm_limit(const TuneResult& result, double damping, double smoothing, Burden burden) {
    double limit = 0;
    for (const TunePoint& point : result.map) {
        if (point.c != damping || point.smoothing != smoothing) continue;
        if (!point.calm(Burden::none) || !point.calm(burden)) break;
        limit = point.k;
    }
    return limit;
}

TuneResult tune(const TuneSetup& setup, const std::atomic<bool>& stop, const Progress& progress) {
    TuneResult out;
    for (const double smoothing : setup.smoothing) {
        for (const double c : setup.damping) {
            for (const double k : setup.stiffness) out.map.push_back({k, c, smoothing, {}});
        }
    }
    judge_all(setup, out.map, stop, part_of(progress, "the map", 0, 0.85));

    std::vector<Bracket> rows = best_rows(setup, out);
    bisect(setup, rows, stop, progress);
    out.interrupted = stop;
    if (rows.empty() || stop) return out;

    const Bracket& best = least_damped(rows);
    out.proposal = stiffest_calm(setup, best, stop, progress);
    std::vector<TunePoint> stiffer{{kNotMargin * out.proposal->k, best.c, best.smoothing, {}}};
    judge_all(setup, stiffer, stop, part_of(progress, "the proposal", 0.97, 1));
    out.stiffer = stiffer.front();
    out.interrupted = stop;
    return out;
}

std::string settings_block(const TuneResult& result, const TuneSetup& setup) {
    const TunePoint& p = *result.proposal;
    std::string out = fmt::format(
        "settings:\n  coupling:\n    kind: {}\n    stiffness_N_m: {:.6g}\n"
        "    damping_Ns_m: {:.6g}\n",
        enum_name(setup.settings.coupling.kind), p.k, p.c);
    if (dual(setup)) out += fmt::format("    smoothing: {:g}\n", p.smoothing);
    return out;
}

std::string to_json(const TuneResult& result, const TuneSetup& setup) {
    using Json = nlohmann::ordered_json;
    Json out;
    out["coupling"] = enum_name(setup.settings.coupling.kind);
    out["solver"] = enum_name(setup.settings.dynamics.solver);
    out["proxy"] = enum_name(setup.settings.proxy.kind);
    out["rate_hz"] = setup.settings.rate;
    out["grip_n"] = setup.grip;
    out["hand"] = {{"stiffness_n_m", setup.hand.stiffness}, {"damping_ns_m", setup.hand.damping}};
    out.update(FigureJson<Json>::of(result));
    return out.dump(2) + "\n";
}

std::string to_table(const TuneResult& result, const TuneSetup& setup) {
    std::string out = fmt::format(
        "{}, solver {}, {:g} Hz; hand of {:g} N/m and {:g} N*s/m, grip of {:g} N\n\nstiffest calm "
        "hold of a block of 100 g, N/m\n{}damping N*s/m",
        enum_name(setup.settings.coupling.kind), enum_name(setup.settings.dynamics.solver),
        setup.settings.rate, setup.hand.stiffness, setup.hand.damping, setup.grip,
        dual(setup) ? "smoothing  " : "");
    for (const Burden burden : kAllBurdens) out += fmt::format("  {:>10s}", enum_name(burden));
    out += "\n";
    for (const double smoothing : setup.smoothing) {
        for (const double c : setup.damping) {
            if (dual(setup)) out += fmt::format("{:9g}  ", smoothing);
            out += fmt::format("{:13g}", c);
            for (const Burden burden : kAllBurdens)
                out += fmt::format("  {:10g}", calm_limit(result, c, smoothing, burden));
            out += "\n";
        }
    }
    if (!result.proposal) {
        return out +
               "\nno setting is calm with a margin: see the map for settings that are calm without "
               "one\n";
    }
    out +=
        fmt::format("\nproposal: {:.6g} N/m, {:.6g} N*s/m", result.proposal->k, result.proposal->c);
    if (dual(setup)) out += fmt::format(", smoothing {:g}", result.proposal->smoothing);
    out +=
        "\n  calm unchanged, with another tick of delay, with 10 g, in a loose and in a firm "
        "hand\n";
    const TunePoint& stiffer = *result.stiffer;
    out += fmt::format("  at {:.6g} N/m:", stiffer.k);
    for (const Burden burden : kAllBurdens) {
        const auto& verdict = stiffer.verdicts[burden];
        if (verdict) out += fmt::format(" {}: {};", enum_name(burden), enum_name(*verdict));
    }
    out.back() = '\n';
    return out;
}

}  // namespace dihaptic::measure
