#include "analysis/report/measure_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/measures/measures.h"
#include "analysis/perturbations.h"
#include "analysis/report/session_page.h"
#include "analysis/report/statistics.h"
#include "task/plan/measures.h"

namespace dihaptic::analysis {
namespace {

/// How often a measure is missing, by reason: "no movement (3), not over when its states ended
/// (1)".
std::string reasons(const rows::TrialFile& trials, const std::string& measure) {
    const auto column = trials.column(task::kNotMeasured);
    std::vector<std::string> order;
    std::map<std::string, int> counts;
    for (size_t i = 0; i < trials.size(); ++i) {
        std::string text = trials.text(i, column) + "; ";
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

/// A measure, trial by trial, by condition.
Chart measure_chart(const SessionData& session, const Table::Column& column) {
    const rows::TrialFile& trials = session.trials;
    const auto measured = trials.column(column.name);
    Chart chart{column.name, "attempt", column.unit, origin_of(session), {}, {}};
    std::vector<std::string> conditions;
    std::string block;
    for (size_t i = 0; i < trials.size(); ++i) {
        const std::string& condition = trials[i].asked.condition;
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
        series.y.push_back(trials.number(i, measured));
        if (trials[i].asked.block != block) {
            block = trials[i].asked.block;
            chart.marks.push_back({static_cast<double>(i + 1), block});
        }
    }
    return chart;
}

/// Names of the task's factors, as used in columns of trials.
std::vector<std::string> factors_of(const SessionData& session) {
    std::vector<std::string> out;
    for (const task::Factor& factor : session.task.cross) out.push_back(factor.factor);
    if (out.empty() && !session.task.conditions.empty()) {
        for (const Node::Entry& factor : session.task.conditions.front().factors.entries)
            out.push_back(factor.key);
    }
    return out;
}

/// Levels of factors: numbers in ascending order, texts in alphabetical order.
using Levels = std::vector<std::pair<double, std::string>>;

Levels levels_of(const rows::TrialFile& trials, size_t i, const std::vector<std::string>& factors) {
    Levels out;
    // rounds are never averaged over
    if (const std::string& round = trials[i].asked.round; !round.empty())
        out.emplace_back(0, round);
    for (const std::string& factor : factors) {
        const auto column = trials.column(factor);
        const double number = trials.number(i, column);
        out.emplace_back(std::isnan(number) ? 0 : number, factor + " " + trials.text(i, column));
    }
    return out;
}

Series series_of(const Levels& levels, const std::map<double, std::vector<double>>& by_x) {
    Series out;
    for (const auto& [unused, level] : levels) out.name += (out.name.empty() ? "" : ", ") + level;
    if (out.name.empty()) out.name = "mean";
    for (const auto& [x, own] : by_x) {
        const Sample s = sample(own);
        out.x.push_back(x);
        out.y.push_back(s.mean);
        out.low.push_back(s.mean_interval.low);
        out.high.push_back(s.mean_interval.high);
    }
    return out;
}

/// Means of a measure by the levels of a numeric factor, for each combination of the other factors:
/// over trials, or over several people, who count once each. Has no series if no factor is numeric.
Chart factor_chart(std::span<const SessionData* const> sessions, const Table::Column& column,
                   const std::string& origin) {
    std::vector<std::string> factors = factors_of(*sessions.front());
    const auto numeric = std::find_if(factors.begin(), factors.end(), [&](const auto& factor) {
        const rows::TrialFile& trials = sessions.front()->trials;
        return !trials.empty() && !std::isnan(trials.number(0, trials.column(factor)));
    });
    if (numeric == factors.end()) return {};
    const std::string over = *numeric;
    factors.erase(numeric);
    std::map<Levels, std::map<double, std::map<std::string, std::vector<double>>>> values;
    for (const SessionData* session : sessions) {
        const rows::TrialFile& trials = session->trials;
        const auto measured = trials.column(column.name), numbers = trials.column(over);
        for (size_t i = 0; i < trials.size(); ++i) {
            const double value = trials.number(i, measured);
            if (is_aside(trials[i].asked.kind) || std::isnan(value)) continue;
            values[levels_of(trials, i, factors)][trials.number(i, numbers)][session->participant()]
                .push_back(value);
        }
    }
    Chart chart{column.name + " by " + over,
                over,
                column.unit,
                "Means and their 95 % intervals, without practice and catch trials. " + origin,
                {},
                {}};
    for (const auto& [levels, by_x] : values) {
        std::map<double, std::vector<double>> samples;
        for (const auto& [x, people] : by_x) {
            for (const auto& [unused, own] : people) {
                std::vector<double>& all = samples[x];
                if (sessions.size() == 1) {
                    all = own;
                } else {
                    all.push_back(sample(own).mean);
                }
            }
        }
        chart.series.push_back(series_of(levels, samples));
    }
    return chart;
}

}  // namespace

std::vector<Table::Column> measured_columns(const SessionData& session) {
    const rows::TrialFile& trials = session.trials;
    std::vector<Table::Column> out = measure_columns_of(session.task);
    out.pop_back();  // the column of missing measures
    std::erase_if(out, [&](const Table::Column& c) { return !trials.column(c.name); });
    // in a session without the measures, a column with this name is a different one
    if (!trials.column(task::kNotMeasured)) out.clear();
    return out;
}

void add_measures(Page& page, const SessionData& session) {
    const std::vector<Table::Column> columns = measured_columns(session);
    if (columns.empty()) return;
    page.heading("Measures");
    page.text(
        "The task's measures of each attempt, as defined in docs/measures-of-behaviour.md. Values "
        "that could not be computed are left out, not zero.");
    Table table{{{"measure", ""},
                 {"unit", ""},
                 {"attempts", "attempts with a value"},
                 {"mean", ""},
                 {"SD", ""},
                 {"missing", "numbers and reasons"}},
                {}};
    for (const Table::Column& column : columns) {
        std::string measure = column.name;
        for (const task::MeasureRow& row : task::kMeasureTable) {
            const auto of_row = task::columns_of_measure(row);
            const auto is_it = [&](const Table::Column& c) { return c.name == column.name; };
            if (std::any_of(of_row.begin(), of_row.end(), is_it)) measure = row.name;
        }
        const std::string why = reasons(session.trials, measure);
        std::vector<double> values;
        const auto measured = session.trials.column(column.name);
        for (size_t i = 0; i < session.trials.size(); ++i)
            values.push_back(session.trials.number(i, measured));
        const Sample all = sample(values);
        table.rows.push_back(
            {column.name, column.unit, static_cast<double>(all.count), all.mean, all.sd, why});
        page.chart(measure_chart(session, column));
        Chart by_factor = factor_chart(std::array{&session}, column, origin_of(session));
        if (!by_factor.series.empty()) page.chart(std::move(by_factor));
    }
    page.table(table, "Over all attempts. " + origin_of(session));
}

void add_measures_of_people(Page& page, std::span<const SessionData* const> sessions,
                            const std::string& origin) {
    for (const Table::Column& column : measured_columns(*sessions.front())) {
        Chart chart = factor_chart(sessions, column, origin);
        if (!chart.series.empty()) page.chart(std::move(chart));
    }
}

}  // namespace dihaptic::analysis
