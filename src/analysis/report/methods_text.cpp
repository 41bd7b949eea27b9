#include "analysis/report/methods_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/perturbations.h"
#include "analysis/report/measure_section.h"
#include "analysis/report/statistics.h"
#include "analysis/session_report.h"
#include "base/plural.h"

namespace dihaptic::analysis {
namespace {

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& items) {
    if (items.size() < 2) return fmt::format("{}", fmt::join(items, ""));
    const std::vector<std::string> first(items.begin(), items.end() - 1);
    return fmt::format("{} and {}", fmt::join(first, ", "), items.back());
}

std::string number(double value) {
    return fmt::format("{:.3g}", value);
}

/// Value of a setting; "" if it is missing, or if the program chooses its default.
std::string setting(const Table& settings, const std::string& name) {
    for (const auto& row : settings.rows) {
        if (std::get<std::string>(row[0]) == name) return std::get<std::string>(row[1]);
    }
    return "";
}

std::string who(const SessionData& session) {
    const recording::SessionInfo& info = session.info;
    if (!info.moved_by.person()) return info.moved_by.describe();
    std::vector<std::string> about;
    const recording::Participant& person = info.participant;
    if (!person.age.empty()) about.push_back(person.age + " years");
    if (!person.sex.empty()) about.push_back("sex " + person.sex);
    if (!person.handedness.empty()) about.push_back(person.handedness + "-handed");
    return fmt::format("Participant {}{} took part.", session.participant(),
                       about.empty() ? "" : fmt::format(" ({})", fmt::join(about, ", ")));
}

std::string apparatus(const SessionData& session) {
    const Table settings = read_settings(session.folder);
    std::vector<std::string> devices;
    for (const recording::DeviceRecord& device : session.info.devices)
        devices.push_back(fmt::format("{} ({})", device.finger, device.model));
    std::string out = fmt::format("Forces were computed and recorded {} times a second by {}",
                                  setting(settings, "rate_Hz"), session.info.program);
    if (!devices.empty())
        out += fmt::format(", and rendered to {} through {}", listed(devices),
                           devices.size() == 1 ? "its device" : "a device each");
    const std::string stiffness = setting(settings, "coupling.stiffness_N_m");
    out += ". ";
    if (!stiffness.empty())
        out += fmt::format(
            "Device and virtual finger were connected by a virtual coupling of {} N/m. ",
            stiffness);
    return out + fmt::format("Contact and friction were solved with the method {}.",
                             setting(settings, "dynamics.solver"));
}

/// The blocks in order, with their numbers of trials; of several rounds, the first round's blocks.
std::vector<std::string> blocks_of(const SessionData& session) {
    std::vector<std::string> order;
    std::map<std::string, std::pair<std::string, int>> blocks;
    for (const rows::TrialRow& row : session.trials) {
        if (row.measures.attempt != 1 || row.asked.round != session.trials[0].asked.round) continue;
        auto& [kind, count] = blocks[row.asked.block];
        if (++count == 1) {
            order.push_back(row.asked.block);
            kind = enum_name(row.asked.kind);
        }
    }
    std::vector<std::string> out;
    for (const std::string& name : order) {
        const auto& [kind, count] = blocks[name];
        out.push_back(fmt::format("{} ({}{})", name, counted(count, "trial"),
                                  kind.empty() || kind == name ? "" : ", " + kind));
    }
    return out;
}

/// Distinct texts in a column, in order of first appearance.
std::vector<std::string> texts_of(const rows::TrialFile& trials,
                                  std::string rows::AskedRow::*column) {
    std::vector<std::string> out;
    for (const rows::TrialRow& row : trials) {
        const std::string& text = row.asked.*column;
        if (!text.empty() && std::find(out.begin(), out.end(), text) == out.end())
            out.push_back(text);
    }
    return out;
}

std::string design(const SessionData& session) {
    std::vector<std::string> states;
    for (const task::State& state : session.task.states) states.push_back(state.name);
    const std::vector<std::string> conditions =
        texts_of(session.trials, &rows::AskedRow::condition);
    const std::vector<std::string> rounds = texts_of(session.trials, &rows::AskedRow::round);
    const std::vector<std::string> blocks = blocks_of(session);
    std::string out =
        fmt::format("The session (\"{}\", seed {}) had ", session.info.title, session.info.seed);
    if (rounds.size() > 1)
        out += fmt::format("{} rounds ({}), each with ", rounds.size(), listed(rounds));
    out += fmt::format("{}: {}. ", counted(static_cast<int64_t>(blocks.size()), "block"),
                       listed(blocks));
    if (conditions.size() > 1)
        out += fmt::format("There were {} conditions: {}. ", conditions.size(), listed(conditions));
    return out + fmt::format("Each trial went through {}: {}.",
                             counted(static_cast<int64_t>(states.size()), "state"), listed(states));
}

std::string perturbations(const SessionData& session) {
    std::vector<std::string> all;
    const Table table = perturbation_table(session.task);
    for (const auto& row : table.rows) {
        const std::string name = std::get<std::string>(row[0]);
        const std::string in = std::get<std::string>(row[1]);
        all.push_back(fmt::format("{}{}: {}", name, in.empty() ? "" : " (in " + in + ")",
                                  std::get<std::string>(row[2])));
    }
    return all.empty() ? "" : fmt::format("Perturbations: {}.", fmt::join(all, "; "));
}

std::string measures_defined(const SessionData& session) {
    std::vector<std::string> all;
    for (const Table::Column& column : measured_columns(session))
        all.push_back(fmt::format("{} ({})", column.name, column.description));
    return all.empty() ? "" : fmt::format("Measures of each attempt: {}.", fmt::join(all, "; "));
}

std::string outcomes(const SessionData& session) {
    std::map<std::string, int> counts;
    for (const rows::TrialRow& row : session.trials) ++counts[row.measures.outcome];
    std::vector<std::pair<int, std::string>> sorted;
    for (const auto& [name, count] : counts) sorted.emplace_back(count, name);
    std::sort(sorted.rbegin(), sorted.rend());
    std::vector<std::string> texts;
    for (const auto& [count, name] : sorted) texts.push_back(fmt::format("{} {}", count, name));
    return fmt::format("Outcomes of {}: {}.",
                       counted(static_cast<int64_t>(session.trials.size()), "attempt"),
                       listed(texts));
}

/// Mean and standard deviation of a measure in each condition.
std::string measured(const SessionData& session, const Table::Column& column) {
    std::map<std::string, std::vector<double>> by_condition;
    const auto of = session.trials.column(column.name);
    for (size_t i = 0; i < session.trials.size(); ++i) {
        const rows::AskedRow& asked = session.trials[i].asked;
        const double value = session.trials.number(i, of);
        if (is_aside(asked.kind) || std::isnan(value)) continue;
        by_condition[asked.condition].push_back(value);
    }
    std::vector<std::string> texts;
    for (const auto& [condition, values] : by_condition) {
        const Sample s = sample(values);
        const std::string sd = s.count > 1 ? fmt::format(" (SD {})", number(s.sd)) : "";
        texts.push_back(fmt::format("{}{}{}, n = {}", condition.empty() ? "" : condition + " ",
                                    number(s.mean), sd, s.count));
    }
    return texts.empty() ? "" : fmt::format("{}: {}.", column.name, fmt::join(texts, "; "));
}

/// A round's compensation, window by window.
std::string adapted(const AdaptationCurve& curve, const Table& windows) {
    std::vector<std::string> texts;
    for (const auto& row : windows.rows) {
        if (std::get<std::string>(row[0]) != curve.round) continue;
        texts.push_back(fmt::format("{} ({}) in {}", number(std::get<double>(row[2])),
                                    std::get<std::string>(row[3]), std::get<std::string>(row[1])));
    }
    if (texts.empty()) return "";
    return fmt::format("{}Compensation [{}], with its 95 % interval over trials, was {}.",
                       curve.round.empty() ? "" : fmt::format("Round {}: ", curve.round),
                       curve.unit, listed(texts));
}

/// A row of a table as "COLUMN VALUE, COLUMN VALUE", without unmeasured values.
std::string row_in_words(const Table& table, const std::vector<Table::Cell>& row, size_t first) {
    std::vector<std::string> out;
    for (size_t i = first; i < row.size(); ++i) {
        const auto* value = std::get_if<double>(&row[i]);
        const std::string text = value == nullptr     ? std::get<std::string>(row[i])
                                 : std::isnan(*value) ? ""
                                                      : number(*value);
        if (!text.empty() && text != "-")
            out.push_back(fmt::format("{} {}", table.columns[i].name, text));
    }
    return fmt::format("{}", fmt::join(out, ", "));
}

}  // namespace

MethodsText methods_text(const SessionData& session, const SessionPage& page, const Table& windows,
                         const Table& lifts) {
    MethodsText out;
    const auto add = [](std::vector<std::string>& to, const std::string& text) {
        if (!text.empty()) to.push_back(text);
    };
    add(out.methods, who(session) + " " + apparatus(session));
    if (!session.task.states.empty()) add(out.methods, design(session));
    add(out.methods, perturbations(session));
    add(out.methods, measures_defined(session));
    add(out.results, outcomes(session));
    for (const Table::Column& column : measured_columns(session))
        add(out.results, measured(session, column));
    for (const AdaptationCurve& curve : session.curves) add(out.results, adapted(curve, windows));
    for (const auto& row : page.thresholds.rows)
        add(out.results, fmt::format("Procedure {}: {}.", to_text(row[0]),
                                     row_in_words(page.thresholds, row, 1)));
    for (const auto& row : lifts.rows)
        add(out.results,
            fmt::format("Lifts, {} (medians): {}.", to_text(row[0]), row_in_words(lifts, row, 1)));
    return out;
}

}  // namespace dihaptic::analysis
