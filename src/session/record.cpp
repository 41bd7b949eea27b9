#include "session/record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base/plural.h"

namespace dihaptic::session {
namespace {

/// Says that no trial was done, or that all were to be repeated; "" otherwise.
std::string without_trials(const Recorded& session, const Plan& plan) {
    const std::optional<Table>& trials = session.figures.trials;
    if (!plan.task || !trials || session.interrupted || !session.fault.empty()) return "";
    const auto column =
        static_cast<size_t>(std::ranges::find(trials->columns, "outcome", &Table::Column::name) -
                            trials->columns.begin());
    std::set<std::string> ended;
    for (const auto& row : trials->rows) ended.insert(std::get<std::string>(row[column]));
    if (ended.empty())
        return "no trial was done: see whether the task's criteria (until, needs) hold from the "
               "start";
    const auto is_repeated = [&](const std::string& name) {
        const auto& known = plan.task->outcomes;
        const auto found = std::ranges::find(known, name, &task::TaskPlan::Outcome::name);
        return found != known.end() && found->redo;
    };
    if (!std::ranges::all_of(ended, is_repeated)) return "";
    return fmt::format("none of {} ended as a trial should: after {} the trial is repeated (redo)",
                       counted(static_cast<int64_t>(trials->rows.size()), "attempt"),
                       fmt::join(ended, " and "));
}

std::vector<std::string> closing_notes(const Recorded& session, const Plan& plan) {
    std::vector<std::string> out;
    for (const std::string& what : {session.fault, session.stall}) {
        if (!what.empty()) out.push_back("WARNING: " + what);
    }
    for (const std::string& what : session.undecided) out.push_back("WARNING: " + what);
    if (const std::string what = without_trials(session, plan); !what.empty())
        out.push_back("WARNING: " + what);
    const analysis::SessionFigures& figures = session.figures;
    uint32_t told = figures.status & ~(kPaused | kResumed | kSoftStarted);
    // the fault already reports that the operator stopped the session
    if (figures.ticks_with(kStopped) > 0) told &= ~(kStopped | kForceOff);
    for_each_status(told, [&](Status bit) {
        const StatusRow& row = describe(bit);
        const bool grave = bit == kNotFinite || bit == kUnbalanced;
        const std::string what = bit == kUnbalanced
                                     ? figures.describe_imbalance()
                                     : fmt::format("in {} of {} {}", figures.ticks_with(bit),
                                                   counted(figures.frames, "tick"), row.what);
        out.push_back(fmt::format("{}: {}{}", grave ? "WARNING" : "note", what,
                                  row.remedy.empty() ? "" : fmt::format(": {}", row.remedy)));
    });
    for (const std::string& what : figures.implausible) out.push_back("WARNING: " + what);
    if (session.timing.refusals.any()) {
        out.push_back("note: " +
                      servo::describe(session.timing.refusals, plan.settings.real_time_priority));
    }
    if (session.dropped > 0) {
        out.push_back(fmt::format("WARNING: {} could not be recorded: the disk is too slow",
                                  counted(session.dropped, "frame")));
    }
    if (figures.log.left_out > 0)
        out.push_back("note: " + recording::describe_left_out(figures.log.left_out, figures.tick));
    return out;
}

}  // namespace

Recorded record(const Plan& plan, RunOptions options, const std::atomic<bool>& stop,
                const Progress& running, const Finishing& finishing,
                std::unique_ptr<devices::DeviceGroup> devices) {
    std::optional<analysis::SessionReader> reader;
    if (!options.keep_log) {
        options.in_place_of_log = [&](const recording::SessionFolder& folder,
                                      const recording::SessionInfo& info,
                                      const recording::LogHead& head) -> frame::FrameSink {
            reader.emplace(folder, info, head);
            return [&reader](const frame::Frame& frame) { reader->add(frame); };
        };
    }
    Recorded out{run_session(plan, options, stop, running, std::move(devices)), {}, {}};
    const auto progressed = [&](double share) {
        if (finishing) finishing(out.folder, share);
    };
    progressed(0);
    const auto folder = recording::SessionFolder::open_tables(out.folder);
    out.figures = reader ? analysis::finish_tables(folder, out.info, std::move(*reader))
                         : analysis::finish_session(folder, out.info, progressed);
    out.lock.reset();
    out.earlier.reset();
    out.notes = closing_notes(out, plan);
    return out;
}

}  // namespace dihaptic::session
