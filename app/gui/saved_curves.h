// Saves the curves of a recorded session: as a figure, or as numbers.
#pragma once

#include <QString>
#include <vector>

#include "base/table.h"
#include "recording/log_browser.h"
#include "task/run/recorded.h"

namespace dihaptic::gui {

class TimeChart;

/// Draws the chart into a file: SVG, PDF or PNG, depending on the end of its name. Throws Error if
/// it cannot be written, or if its name has another end.
void save_figure(const TimeChart& chart, const QString& file);

/// The values of all expressions in each tick from `begin` to `end` [s]. `names`: the expressions
/// as they were typed.
Table table_of_curves(recording::LogBrowser& log, std::vector<task::RecordedValue>& values,
                      const QStringList& names, double begin, double end);

}  // namespace dihaptic::gui
