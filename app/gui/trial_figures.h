// Reads the results of a running session's trials (errors, angles, the task's custom measures), in
// a separate thread, from the log that the session writes.
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

    /// Follows the session recorded in a folder; an earlier one is dropped.
    void follow(const QString& folder);
    /// The session is over: reads the rest of it.
    void finish() { over_ = true; }

  Q_SIGNALS:
    /// A row for each attempt so far, as trials.csv will have it.
    void found(const dihaptic::Table& trials);

  private:
    void tell(Table table, const std::stop_token& stop);

    std::atomic<bool> over_{false};
    std::jthread thread_;
};

}  // namespace dihaptic::gui
