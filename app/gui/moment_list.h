// The list of the moments of a recorded session, in which the moment that was last passed is
// marked.
#pragma once

#include <QTreeWidget>
#include <map>
#include <optional>
#include <vector>

namespace dihaptic::gui {

class MomentList : public QTreeWidget {
    Q_OBJECT

  public:
    explicit MomentList(QWidget* parent = nullptr);

    /// Adds a moment at the given time [s], unless the time is NaN because it was not measured.
    void add(double seconds, const QString& what);
    /// Adds a moment that may occur often: only the first is listed, with how often it occurred.
    void add_counted(double seconds, const QString& what);
    /// Sorts the list. To be called once, after all moments were added.
    void finish();
    /// The times of all moments, in order [s].
    const std::vector<double>& times() const { return times_; }
    /// Marks the last moment up to this time [s].
    void show_time(double time);
    /// The next moment after this time or, if `way` is negative, the previous one [s].
    std::optional<double> next_from(double time, int way) const;

  Q_SIGNALS:
    /// The user chose a moment [s].
    void chosen(double time);

  private:
    std::map<QString, QTreeWidgetItem*> counted_;
    std::vector<double> times_;
};

}  // namespace dihaptic::gui
