#include "analysis/report/measure_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/report/session_page.h"
#include "analysis/report/statistics.h"
#include "task/measures.h"

namespace dihaptic::analysis {
namespace {

/// Columns of the task's measures that are in the trials.
std::vector<Table::Column> measured_columns(const CsvFile& trials) {
    std::vector<Table::Column> out = task::measure_columns();
    out.pop_back();  // what is not measured
    std::erase_if(out, [&](const Table::Column& c) { return !trials.has(c.name); });
    // of a session without the measures, a column of the same name is another
    if (!trials.has(task::kNotMeasured)) out.clear();
    return out;
}

/// How often a measure is missing, by why: "no movement (3), not over when its states ended (1)".
std::string reasons(const CsvFile& trials, const std::string& measure) {
    std::vector<std::string> order;
    std::map<std::string, int> counts;
    for (size_t i = 0; i < trials.rows(); ++i) {
        std::string text = trials.text(i, task::kNotMeasured) + "; ";
        for (size_t end = text.find("; "); end != std::string::npos; end = text.find("; ")) {
            const std::string one = text.substr(0, end);
            text.erase(0, end + 2);
            const bool of_all = one.find(": ") == std::string::npos;
            if (one.empty() || (!of_all && !one.starts_with(measure + ": "))) continue;
            const std::string why = of_all ? one : one.substr(measure.size() + 2);
            if (++counts[why] == 1) order.push_back(why);
        }
    }
    std::string out;
    for (const std::string& why : order)
        out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", why, counts[why]);
    return out;
}

/// A measure trial by trial, by condition.
Chart measure_chart(const SessionData& session, const Table::Column& column) {
    const CsvFile& trials = session.trials;
    Chart chart{column.name, "attempt", column.unit, origin_of(session), {}, {}};
    std::vector<std::string> conditions;
    std::string block;
    for (size_t i = 0; i < trials.rows(); ++i) {
        const std::string condition = trials.text(i, "condition");
        if (std::find(conditions.begin(), conditions.end(), condition) == conditions.end()) {
            conditions.push_back(condition);
            chart.series.push_back({condition.empty() ? column.description : condition,
                                    Drawn::points,
                                    {},
                                    {},
                                    {},
                                    {},
                                    {}});
        }
        const auto at = std::find(conditions.begin(), conditions.end(), condition);
        Series& series = chart.series[static_cast<size_t>(at - conditions.begin())];
        series.x.push_back(static_cast<double>(i + 1));
        series.y.push_back(trials.number(i, column.name));
        if (trials.text(i, "block") != block) {
            block = trials.text(i, "block");
            chart.marks.push_back({static_cast<double>(i + 1), block});
        }
    }
    return chart;
}

}  // namespace

void add_measures(Page& page, const SessionData& session) {
    const std::vector<Table::Column> columns = measured_columns(session.trials);
    if (columns.empty()) return;
    page.heading("Measures");
    page.text(
        "The task's measures of each attempt, as docs/measures-of-behaviour.md defines them. What "
        "could not be computed is left out, and not zero.");
    Table table{{{"measure", ""},
                 {"unit", ""},
                 {"attempts", "with a value"},
                 {"mean", ""},
                 {"SD", ""},
                 {"missing", "how often, and why"}},
                {}};
    std::string why;
    for (const Table::Column& column : columns) {
        for (const task::MeasureRow& row : task::kMeasureTable) {
            const auto own = task::columns_of_measure(row);
            if (own.front().name == column.name) why = reasons(session.trials, row.name);
        }
        std::vector<double> values;
        for (size_t i = 0; i < session.trials.rows(); ++i)
            values.push_back(session.trials.number(i, column.name));
        const Sample all = sample(values);
        table.rows.push_back(
            {column.name, column.unit, static_cast<double>(all.count), all.mean, all.sd, why});
        page.chart(measure_chart(session, column));
    }
    page.table(table, "Over all attempts. " + origin_of(session));
}

}  // namespace dihaptic::analysis
