#include "plots_panel.h"

#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/palette.h"
#include "frame/displayed.h"
#include "theme.h"
#include "view/colours.h"

namespace dihaptic::gui {
namespace {

constexpr size_t kGrips = 1000;        // samples of grip against load: ten seconds
constexpr size_t kNewGrips = 100;      // the last second of them, which is drawn strongly
constexpr size_t kLongestPath = 3000;  // points of a path
constexpr double kStep = 0.5;          // shortest distance between points of a path [mm]

/// The colour of the object, as it appears on the screen.
QColor screen_colour(const Vec3& linear) {
    const auto srgb = [](double x) {  // IEC 61966-2-1
        return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    };
    return QColor::fromRgbF(static_cast<float>(srgb(linear.x())),
                            static_cast<float>(srgb(linear.y())),
                            static_cast<float>(srgb(linear.z())));
}

/// The colour of what is past.
QColor paler(QColor colour) {
    colour.setAlpha(90);
    return colour;
}

size_t finger_that_reaches(const session::Plan& plan) {
    const bool named =
        plan.task && plan.task->task.reach && plan.task->task.reach->finger.index > 0;
    return named ? static_cast<size_t>(plan.task->task.reach->finger.index) : 0;
}

/// Appends a point [m] to a path [mm], unless it is where the path ends.
void extend(std::vector<Vec3>& path, const Vec3& point) {
    const Vec3 in_mm = 1e3 * point;
    if (path.size() < kLongestPath && (path.empty() || (path.back() - in_mm).norm() > kStep))
        path.push_back(in_mm);
}

}  // namespace

PlotKind plot_kind(const session::Plan& plan) {
    if (plan.task && !plan.task->task.procedures.empty()) return PlotKind::threshold;
    if (plan.task && plan.task->task.reach) return PlotKind::reach;
    const bool grasps =
        plan.scene.object_index() >= 0 && scene::finger_names(plan.scene).size() > 1;
    return grasps ? PlotKind::lift : PlotKind::touch;
}

PlotsPanel::PlotsPanel(QWidget* parent) : QWidget(parent), layout_(new QVBoxLayout(this)) {
    layout_->setContentsMargins(space::kUsual, space::kTight, space::kUsual, space::kTight);
    layout_->setSpacing(space::kTight);
}

void PlotsPanel::set_plan(const session::Plan& plan) {
    const scene::Scene& scene = plan.scene;
    const int object = scene.object_index();
    has_object_ = object >= 0;
    names_.clear();
    for (const std::string& name : scene::finger_names(scene)) {
        if (names_.size() == session::CurveSample::kFingers) break;
        names_.push_back({QString::fromStdString(name),
                          legible(screen_colour(view::finger_colour(names_.size())))});
    }
    things_ = names_;
    if (has_object_) {
        const auto body = static_cast<size_t>(object);
        things_.push_back({QString::fromStdString(scene.bodies[body].name),
                           legible(screen_colour(view::body_colour(scene, body)))});
    }
    finger_ = finger_that_reaches(plan);
    kind_ = plot_kind(plan);
    make_charts();
}

void PlotsPanel::make_charts() {
    for (QWidget* chart : std::exchange(charts_, {})) delete chart;
    trials_ = nullptr;
    path_ = ratio_ = nullptr;
    grasp_ = fingers_ = heights_ = nullptr;
    grips_.clear();
    trial_ = 0;
    const auto add = [&](auto* chart, int stretch) {
        layout_->addWidget(chart, stretch);
        charts_.push_back(chart);
        return chart;
    };
    const bool grasps = kind_ == PlotKind::lift ||
                        (kind_ == PlotKind::threshold && has_object_ && names_.size() > 1);
    if (kind_ == PlotKind::reach) {
        path_ = add(new PlaneChart(100, true), 2);
        path_->set_names(tr("path from above [mm]"), "");
    }
    if (kind_ == PlotKind::threshold || kind_ == PlotKind::reach)
        trials_ = add(new TrialChart, kind_ == PlotKind::threshold ? 2 : 1);
    if (grasps) {
        const QColor grip = legible(palette::kGrip), load = legible(palette::kLoad);
        grasp_ = add(new StripChart(tr("grip and load force"), "N",
                                    {{tr("grip"), grip}, {tr("load"), load}}, 1),
                     1);
    } else {
        fingers_ = add(new StripChart(tr("force on each finger"), "N", names_, 1), 1);
    }
    if (kind_ == PlotKind::lift) {
        ratio_ = add(new PlaneChart(1, false), 1);
        ratio_->set_names(tr("grip force [N] against load force [N]"), tr("load force [N]"));
    }
    if (kind_ == PlotKind::lift || kind_ == PlotKind::touch)
        heights_ = add(new StripChart(tr("height"), "mm", things_, 50), 1);
}

void PlotsPanel::add(const session::CurveSample& sample) {
    const auto count = static_cast<std::ptrdiff_t>(names_.size());
    if (grasp_ != nullptr) grasp_->add(sample.time, {sample.grip_force, sample.load_force});
    if (fingers_ != nullptr)
        fingers_->add(sample.time, {sample.forces.begin(), sample.forces.begin() + count});
    if (heights_ != nullptr) {
        std::vector<double> heights(sample.heights.begin(), sample.heights.begin() + count);
        if (has_object_) heights.push_back(sample.object_height);
        for (double& height : heights) height *= 1e3;
        heights_->add(sample.time, heights);
    }
    if (ratio_ == nullptr) return;
    grips_.emplace_back(sample.load_force, sample.grip_force);
    if (grips_.size() > kGrips) grips_.pop_front();
}

void PlotsPanel::show_frame(const frame::Frame& frame) {
    if (ratio_ != nullptr) show_grips();
    if (path_ == nullptr || finger_ >= frame.fingers.size()) return;
    follow_path(frame);
    show_path(frame);
}

void PlotsPanel::show_grips() {
    const QColor colour = legible(palette::kGrip);
    const auto newest =
        grips_.end() - static_cast<std::ptrdiff_t>(std::min(grips_.size(), kNewGrips));
    ratio_->set({{{grips_.begin(), grips_.end()}, paler(colour), 1.5, ""},
                 {{newest, grips_.end()}, colour, 2, tr("last second")}});
}

void PlotsPanel::follow_path(const frame::Frame& frame) {
    if (frame.trial != trial_) {
        before_ = trial_ == 0 || frame.trial < trial_ ? std::vector<Vec3>() : hand_;
        hand_.clear();
        shown_.clear();
        trial_ = frame.trial;
    }
    if (frame.phase <= 0) return;  // between trials
    extend(hand_, frame.fingers[finger_].p_WH);
    extend(shown_, frame::displayed_handle(frame, finger_).p);
}

/// Shows the paths in the plane in which the reach goes: from above, or from the front if the
/// target is rather above or below than beyond.
void PlotsPanel::show_path(const frame::Frame& frame) {
    std::vector<Vec3> targets;
    for (size_t i = 0; i < frame.task.targets.size(); ++i)
        targets.push_back(1e3 * frame::displayed_target(frame, i));
    bool from_front = false;
    if (!targets.empty() && !hand_.empty()) {
        const Vec3 way = targets.back() - hand_.front();
        from_front = std::abs(way.z()) > std::abs(way.y());
    }
    const auto seen = [&](const Vec3& point) {
        return QPointF(point.x(), from_front ? point.z() : point.y());
    };
    const auto line = [&](const std::vector<Vec3>& path) {
        std::vector<QPointF> out;
        for (const Vec3& point : path) out.push_back(seen(point));
        return out;
    };
    const QColor colour = names_[finger_].colour;
    std::vector<PlaneChart::Line> lines{{line(before_), paler(colour), 1.5, ""},
                                        {line(hand_), colour, 2, tr("hand")}};
    const bool differs =
        !hand_.empty() && !shown_.empty() && (hand_.back() - shown_.back()).norm() > 2 * kStep;
    if (differs) lines.push_back({line(shown_), legible("#808080"), 1.5, tr("as shown")});
    std::vector<PlaneChart::Circle> circles;
    for (size_t i = 0; i < targets.size(); ++i)
        circles.push_back(
            {seen(targets[i]), 1e3 * frame.task.targets[i].radius, legible(palette::kLoad)});
    path_->set_names(from_front ? tr("path from the front [mm]") : tr("path from above [mm]"), "");
    path_->set(std::move(lines), std::move(circles));
}

void PlotsPanel::set_trials(const QString& name, const std::vector<ChartPainter::Entry>& outcomes,
                            const std::vector<TrialChart::Point>& points) {
    if (trials_ != nullptr) trials_->set_points(name, outcomes, points);
    if (path_ == nullptr) return;
    // the last trial's number may not have been measured yet
    const auto measured = std::find_if(points.rbegin(), points.rend(), [](const auto& point) {
        return std::isfinite(point.value);
    });
    path_->set_result(
        measured == points.rend() ? "" : tr("%1: %2").arg(name).arg(measured->value, 0, 'f', 1));
}

}  // namespace dihaptic::gui
