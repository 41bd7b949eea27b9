// A strip with all trials of a session, in their order: each in the colour of its outcome, the
// running one with a frame, and a line where a block begins.
#pragma once

#include <QWidget>
#include <memory>
#include <vector>

#include "outcomes.h"
#include "session/listeners/live.h"

namespace dihaptic::gui {

class TrialStrip : public QWidget {
    Q_OBJECT

  public:
    explicit TrialStrip(QWidget* parent = nullptr);

    /// Called when a session with these trials starts; null for a session without trials.
    void set_plan(std::shared_ptr<const task::TaskPlan> plan);
    void add(const session::TrialEnd& end);
    /// `trial`: number of the running trial, from 1; 0 if there is none.
    void set_current(int trial);
    bool has_trials() const { return !outcomes_.empty(); }
    /// Number of trials whose last attempt had this outcome.
    int count(int outcome) const;

    QSize sizeHint() const override;

  protected:
    void paintEvent(QPaintEvent* event) override;
    bool event(QEvent* event) override;

  private:
    QColor colour_of(int outcome) const;
    QRectF cell(size_t trial) const;
    QString describe(size_t trial) const;
    void draw_legend(QPainter& painter) const;
    int strip_height() const { return height() - fontMetrics().height(); }

    std::shared_ptr<const task::TaskPlan> plan_;
    std::vector<ChartPainter::Entry> kinds_;  ///< the outcomes that the task has
    std::vector<int> outcomes_;  ///< of each trial's last attempt; kNone if it has not been tried
    int current_ = 0;
};

}  // namespace dihaptic::gui
