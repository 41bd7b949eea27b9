#include "study/schedule.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include "base/checksum.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "rows/trial_row.h"

namespace dihaptic::study {
namespace {

/// Returns the recording that represents a session: the first complete recording or, if there is
/// none, the last incomplete one.
const Visit* latest(const std::vector<Visit>& visits, size_t session) {
    const Visit* out = nullptr;
    for (const Visit& visit : visits) {
        if (visit.session == session && (out == nullptr || !out->complete)) out = &visit;
    }
    return out;
}

double share_of(const Visit& visit) {
    return visit.trials == 0 ? 0
                             : static_cast<double>(visit.done) / static_cast<double>(visit.trials);
}

/// Adds a reason to `next` if it is too early or too late to start a session now.
void check_gap(const SessionSpec& session, const Visit& before, double now, Next& next) {
    const double gap = (now - before.started) / 3600;
    if (session.least_gap && gap < *session.least_gap)
        next.against.push_back(
            fmt::format("{:.1f} h after the start of the previous session; at least {:g} h are "
                        "required: {:.1f} h too early",
                        gap, *session.least_gap, *session.least_gap - gap));
    if (session.most_gap && gap > *session.most_gap)
        next.against.push_back(
            fmt::format("{:.1f} h after the start of the previous session; at most {:g} h are "
                        "allowed: {:.1f} h too late",
                        gap, *session.most_gap, gap - *session.most_gap));
}

}  // namespace

double seconds_of(const std::string& iso) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd?dd:dd";
    if (iso.size() != kForm.size()) return kNone;
    std::vector<int> numbers;
    for (size_t i = 0; i < iso.size();) {
        size_t digits = 0;
        while (kForm.substr(i + digits, 1) == "d") ++digits;
        if (digits == 0) {
            if (kForm[i] != '?' && iso[i] != kForm[i]) return kNone;
            ++i;
            continue;
        }
        const auto number = whole_number<int>(std::string_view(iso).substr(i, digits));
        if (!number) return kNone;
        numbers.push_back(*number);
        i += digits;
    }
    const std::chrono::year_month_day date{std::chrono::year(numbers[0]),
                                           std::chrono::month(static_cast<unsigned>(numbers[1])),
                                           std::chrono::day(static_cast<unsigned>(numbers[2]))};
    if (!date.ok()) return kNone;
    const auto days = std::chrono::sys_days(date).time_since_epoch().count();
    const double offset = (iso[19] == '-' ? -1 : 1) * (numbers[6] * 3600.0 + numbers[7] * 60.0);
    return static_cast<double>(days) * 86400 + numbers[3] * 3600.0 + numbers[4] * 60.0 +
           numbers[5] - offset;
}

const Visit* counted(const StudyFile& study, const std::vector<Visit>& visits, size_t session) {
    const Visit* const visit = latest(visits, session);
    if (visit == nullptr || visit->complete) return visit;
    const bool enough = !visit->running && share_of(*visit) >= study.resuming.complete;
    return enough ? visit : nullptr;
}

uint64_t seed_of(const std::string& words) {
    return 1 + whole_number<uint64_t>(checksum_of(words), 16).value_or(0);
}

Next next_for(const StudyFile& study, const std::vector<Visit>& visits, double now) {
    Next next;
    const Visit* before = nullptr;
    for (size_t i = 0; i < study.sessions.size(); ++i) {
        const Visit* visit = latest(visits, i);
        next.session = i;
        if (visit == nullptr) {
            next.act = Act::begin;
            break;
        }
        if (visit->running) {
            next.act = Act::resume;
            next.folder = visit->folder;
            next.against.push_back(fmt::format("{} is running now", visit->folder));
            return next;
        }
        if (!visit->complete) {
            const double age = (now - visit->started) / 3600;
            if (age <= study.resuming.within && visit->trials > 0) {
                next.act = Act::resume;
                next.folder = visit->folder;
                return next;
            }
            if (counted(study, visits, i) == nullptr) {
                next.act = Act::begin;
                next.note = fmt::format(
                    "{} was interrupted {:.1f} h ago with {} of {} trials: it starts again, and "
                    "both recordings are kept",
                    visit->folder, age, visit->done, visit->trials);
                break;
            }
        }
        before = visit;
    }
    if (next.act == Act::begin && before != nullptr) {
        next.after = before->folder;
        check_gap(study.sessions[next.session], *before, now, next);
    }
    return next;
}

std::string unmet(const Condition& condition, const std::string& trials) {
    const rows::TrialFile table(trials);
    const auto column = table.column(condition.column);
    if (!column) {
        return fmt::format("{} has no column '{}', on which this session depends", trials,
                           condition.column);
    }
    std::map<int, size_t> last;  // row of the last attempt at each trial
    for (size_t i = 0; i < table.size(); ++i) last[table[i].asked.trial] = i;
    double sum = 0;
    int count = 0;
    for (const auto& [trial, row] : last) {
        const double value = condition.is.empty()                      ? table.number(row, column)
                             : table.text(row, column) == condition.is ? 1
                                                                       : 0;
        if (std::isnan(value)) continue;
        sum += value;
        ++count;
    }
    const std::string what =
        condition.is.empty() ? fmt::format("the mean of {}", condition.column)
                             : fmt::format("the share of {} = {}", condition.column, condition.is);
    if (count == 0) return fmt::format("{} is not known: no trial of {} has a value", what, trials);
    const double value = sum / count;
    if (condition.at_least && value < *condition.at_least)
        return fmt::format("{} is {:.4g} in {} trials; at least {:g} is required", what, value,
                           count, *condition.at_least);
    if (condition.at_most && value > *condition.at_most)
        return fmt::format("{} is {:.4g} in {} trials; at most {:g} is allowed", what, value, count,
                           *condition.at_most);
    return "";
}

std::vector<std::string> unmet_needs(const SessionSpec& session, const std::string& before) {
    const std::string trials = before + "/trials.csv";
    std::vector<std::string> out;
    for (const Condition& need : session.needs) {
        const std::string why =
            is_there(trials) ? unmet(need, trials)
                             : fmt::format("{}, on which this session depends, is missing", trials);
        if (!why.empty()) out.push_back(why);
    }
    return out;
}

}  // namespace dihaptic::study
