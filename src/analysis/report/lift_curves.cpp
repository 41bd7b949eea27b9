#include "analysis/report/lift_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/report/statistics.h"
#include "base/palette.h"
#include "base/plural.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

constexpr size_t kMostCharts = 16;
constexpr size_t kMostDrawn = 24;  // lifts drawn individually in a chart; the mean is over all

double time_of(size_t point) {
    return -LiftCurves::kBefore + LiftCurves::kStep * static_cast<double>(point);
}

/// By trial and attempt: condition, perturbation, and whether it was a catch trial.
std::map<std::pair<int, int>, std::string> conditions_of(const rows::TrialFile& trials) {
    std::map<std::pair<int, int>, std::string> out;
    for (const rows::TrialRow& row : trials) {
        std::string text = row.asked.condition;
        const auto also = [&](const std::string& what) {
            if (!what.empty()) text += (text.empty() ? "" : ", ") + what;
        };
        also(row.asked.perturbation);
        if (row.asked.kind == rows::TrialKind::catch_trial) also("catch");
        out[{row.asked.trial, row.measures.attempt}] = text;
    }
    return out;
}

/// Mean and standard deviation of curves, point by point, as a series with a band.
Series mean_of(const std::string& name, const char* colour,
               const std::vector<const std::vector<double>*>& curves) {
    Series out{name, Drawn::line, {}, {}, {}, {}, colour};
    for (size_t k = 0; k < curves.front()->size(); ++k) {
        std::vector<double> values;
        for (const auto* curve : curves) values.push_back((*curve)[k]);
        const Sample s = sample(values);
        const double sd = s.count > 1 ? s.sd : 0;
        out.x.push_back(time_of(k));
        out.y.push_back(s.mean);
        out.low.push_back(s.mean - sd);
        out.high.push_back(s.mean + sd);
    }
    return out;
}

Series single(const std::string& name, const char* colour, const std::vector<double>& values) {
    Series out{name, Drawn::faint, {}, values, {}, {}, colour};
    for (size_t k = 0; k < values.size(); ++k) out.x.push_back(time_of(k));
    return out;
}

}  // namespace

LiftCurves::LiftCurves(const SessionData& session, double tick) : tick_(tick) {
    if (!session.lifts) return;
    const auto conditions = conditions_of(session.trials);
    for (const rows::LiftRow& lift : *session.lifts) {
        const auto found = conditions.find({lift.trial, lift.attempt});
        if (!lift.complete() || std::isnan(lift.lift_off)) continue;
        lifts_.push_back(
            {found == conditions.end() ? "" : found->second, lift.trial, lift.lift_off, {}, {}});
    }
    std::sort(lifts_.begin(), lifts_.end(),
              [](const Lift& a, const Lift& b) { return a.lift_off < b.lift_off; });
}

void LiftCurves::see(const frame::Frame& frame) {
    const double now = seconds(frame.time);
    for (size_t i = first_; i < lifts_.size(); ++i) {
        Lift& lift = lifts_[i];
        if (lift.lift_off - kBefore > now + tick_ / 2) break;
        while (lift.grip.size() < kPoints && lift.next() < now + tick_ / 2) {
            // a point whose tick is missing in the log is left out
            const bool there = lift.next() > now - tick_;
            lift.grip.push_back(there ? frame.grip_force : kUnmeasured);
            lift.load.push_back(there ? frame.load_force : kUnmeasured);
        }
        if (i == first_ && lift.grip.size() == kPoints) ++first_;
    }
}

Chart LiftCurves::chart_of(const std::string& condition, const std::string& origin) const {
    std::vector<const Lift*> own;
    std::vector<const std::vector<double>*> grip, load;
    for (const Lift& lift : lifts_) {
        if (lift.condition != condition || lift.grip.size() != kPoints) continue;
        own.push_back(&lift);
        grip.push_back(&lift.grip);
        load.push_back(&lift.load);
    }
    Chart out;
    out.title = condition.empty() ? "Lifts" : "Lifts: " + condition;
    out.x_label = "time from lift-off [s]";
    out.y_label = "N";
    out.marks = {{0, "lift-off"}};
    if (own.empty()) return out;
    const size_t stride = (own.size() + kMostDrawn - 1) / kMostDrawn;
    for (size_t i = 0; i < own.size(); i += stride) {
        const std::string of = fmt::format(" in trial {} ({})", own[i]->trial, i);
        out.series.push_back(single("grip" + of, palette::kGrip, own[i]->grip));
        out.series.push_back(single("load" + of, palette::kLoad, own[i]->load));
    }
    out.series.push_back(mean_of("grip force", palette::kGrip, grip));
    out.series.push_back(mean_of("load force", palette::kLoad, load));
    out.caption =
        fmt::format("{}{}; mean and standard deviation of all. {}",
                    counted(static_cast<int64_t>(own.size()), "complete lift"),
                    stride > 1 ? fmt::format(", of which each {}th is drawn", stride) : "", origin);
    return out;
}

void LiftCurves::add_to(Page& page, const std::string& origin) const {
    std::vector<std::string> conditions;
    for (const Lift& lift : lifts_) {
        if (std::find(conditions.begin(), conditions.end(), lift.condition) == conditions.end())
            conditions.push_back(lift.condition);
    }
    if (conditions.empty()) return;
    page.heading("Each lift");
    std::sort(conditions.begin(), conditions.end());
    for (size_t i = 0; i < conditions.size() && i < kMostCharts; ++i)
        page.chart(chart_of(conditions[i], origin));
    if (conditions.size() > kMostCharts)
        page.text(fmt::format("{} further conditions are not drawn: their lifts are in lifts.csv.",
                              conditions.size() - kMostCharts));
}

}  // namespace dihaptic::analysis
