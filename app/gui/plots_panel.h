// The panel with live plots, chosen by what the open file is about: a reach is a path with its
// target, a lift is grip and load, a threshold is the staircase of its levels.
#pragma once

#include <deque>

#include "plane_chart.h"
#include "session/listeners/live.h"
#include "session/plan.h"
#include "strip_chart.h"
#include "trial_chart.h"

class QVBoxLayout;

namespace dihaptic::gui {

/// What the plots of a session are about.
enum class PlotKind {
    threshold,  ///< a procedure chooses levels
    reach,      ///< a task measures reaches
    lift,       ///< fingers can grasp an object
    touch       ///< anything else
};
PlotKind plot_kind(const session::Plan& plan);

class PlotsPanel : public QWidget {
    Q_OBJECT

  public:
    explicit PlotsPanel(QWidget* parent = nullptr);

    void set_plan(const session::Plan& plan);
    void add(const session::CurveSample& sample);
    void show_frame(const frame::Frame& frame);
    /// Shows a number of each trial, as TrialsPanel chooses it.
    void set_trials(const QString& name, const std::vector<ChartPainter::Entry>& outcomes,
                    const std::vector<TrialChart::Point>& points);

  private:
    void make_charts();
    void show_grips();
    void follow_path(const frame::Frame& frame);
    void show_path(const frame::Frame& frame);

    QVBoxLayout* layout_;
    std::vector<QWidget*> charts_;
    // null unless the kind of session has them
    TrialChart* trials_ = nullptr;
    PlaneChart* path_ = nullptr;
    StripChart* grasp_ = nullptr;
    PlaneChart* ratio_ = nullptr;
    StripChart* fingers_ = nullptr;
    StripChart* heights_ = nullptr;

    PlotKind kind_ = PlotKind::touch;
    std::vector<ChartPainter::Entry> names_;   ///< of the fingers
    std::vector<ChartPainter::Entry> things_;  ///< of the fingers and the object
    bool has_object_ = false;
    size_t finger_ = 0;                        ///< the one that reaches
    std::deque<QPointF> grips_;                ///< load and grip force of the last seconds [N]
    int trial_ = 0;                            ///< the one whose path is followed
    std::vector<Vec3> hand_, shown_, before_;  ///< paths of this trial and the last [mm]
};

}  // namespace dihaptic::gui
