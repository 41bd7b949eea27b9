// Reads the results of a running session's trials (errors, angles, the task's own measures) in a
// separate thread, from the log that the session writes.
#pragma once

#include <QObject>
#include <atomic>
#include <thread>

#include "base/table.h"

namespace dihaptic::gui {

class TrialFigures : public QObject {
    Q_OBJECT

  public:
    TrialFigures();
    ~TrialFigures() override;

    /// Starts to follow the session recorded in `folder`, and drops an earlier one.
    void follow(const QString& folder);
    /// To be called when the session is over: reads the rest of its log.
    void finish() { over_ = true; }

  Q_SIGNALS:
    /// A table with a row for each attempt so far, in the form of trials.csv.
    void found(const dihaptic::Table& trials);

  private:
    void tell(Table table, const std::stop_token& stop);

    std::atomic<bool> over_{false};
    std::jthread thread_;
};

}  // namespace dihaptic::gui
