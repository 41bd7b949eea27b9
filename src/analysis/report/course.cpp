#include "analysis/report/course.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/palette.h"

namespace dihaptic::analysis {
namespace {

constexpr double kLongestDrawn = 60;  // longest session that is drawn completely [s]
constexpr double kBeside = 0.3;       // time drawn before and after a lift [s]
constexpr size_t kMostPoints = 1500;  // most points on a curve over time

Series line(const std::string& name, const char* colour) {
    return {name, Drawn::line, {}, {}, {}, {}, colour};
}

/// Thins a curve to the least and largest value in each stretch, in their order, so that every peak
/// remains.
void thin(Series& series) {
    if (series.x.size() <= kMostPoints) return;
    const size_t stretch = (2 * series.x.size() + kMostPoints - 1) / kMostPoints;
    Series out{series.name, series.drawn, {}, {}, {}, {}, series.colour};
    for (size_t first = 0; first < series.x.size(); first += stretch) {
        const auto begin = series.y.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = series.y.begin() +
                         static_cast<std::ptrdiff_t>(std::min(first + stretch, series.y.size()));
        auto [low, high] = std::minmax_element(begin, end);
        if (high < low) std::swap(low, high);
        for (const auto i : {low, high}) {
            out.x.push_back(series.x[static_cast<size_t>(i - series.y.begin())]);
            out.y.push_back(*i);
        }
    }
    series = std::move(out);
}

}  // namespace

std::optional<CourseCharts::Excerpt> CourseCharts::excerpt_of(const SessionData& session,
                                                              const recording::LogHead& head) {
    if (session.info.ticks * head.tick <= kLongestDrawn) return Excerpt{0, kLongestDrawn};
    if (!session.lifts) return std::nullopt;
    size_t i = 0;
    while (i < session.lifts->size() && !(*session.lifts)[i].complete()) ++i;
    if (i == session.lifts->size()) return std::nullopt;
    const rows::LiftRow& lift = (*session.lifts)[i];
    return Excerpt{lift.touch - kBeside, lift.release + kBeside,
                   fmt::format("Trial {}", lift.trial)};
}

CourseCharts::CourseCharts(const SessionData& session, const recording::LogHead& head)
    : session_(session),
      excerpt_(excerpt_of(session, head)),
      two_(head.fingers.size() > 1),
      grip_(line("grip force", palette::kGrip)),
      load_(line("load force", palette::kLoad)),
      height_(line("height", "")) {
    const auto found = std::find(head.bodies.begin(), head.bodies.end(), session.info.object);
    if (found != head.bodies.end()) object_ = found - head.bodies.begin();
    for (const std::string& finger : head.fingers)
        sent_.push_back(line(finger, palette::finger(sent_.size())));
}

void CourseCharts::see(const frame::Frame& frame) {
    const double t = seconds(frame.time);
    if (!excerpt_ || t < excerpt_->from || t > excerpt_->to) return;
    if (frame.phase != phase_) {
        phase_ = frame.phase;
        const auto k = static_cast<size_t>(phase_);
        if (phase_ >= 0 && k < session_.info.phases.size())
            marks_.push_back({t, session_.info.phases[k].name});
    }
    const auto add = [&](Series& series, double y) {
        series.x.push_back(t);
        series.y.push_back(y);
    };
    if (two_) {
        add(grip_, frame.grip_force);
        add(load_, frame.load_force);
    }
    if (object_ >= 0) add(height_, 1e3 * frame.bodies[static_cast<size_t>(object_)].X_WB.p.z());
    for (size_t f = 0; f < sent_.size(); ++f) add(sent_[f], frame.fingers[f].f_sent_W.norm());
}

void CourseCharts::add_to(Page& page, const std::string& origin) {
    if (!excerpt_) return;
    for (Series* series : {&grip_, &load_, &height_}) thin(*series);
    for (Series& series : sent_) thin(series);
    page.heading(excerpt_->what + " over time");
    const auto chart = [&](std::string title, const char* unit, std::vector<Series> series) {
        page.chart({std::move(title), "time [s]", unit, origin, std::move(series), marks_});
    };
    if (!grip_.x.empty()) chart("Grip and load", "N", {grip_, load_});
    chart("Force sent to each device", "N", sent_);
    if (!height_.x.empty()) chart("Height of the " + session_.info.object, "mm", {height_});
}

}  // namespace dihaptic::analysis
