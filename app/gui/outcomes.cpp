#include "outcomes.h"

#include <array>

#include "theme.h"

namespace dihaptic::gui {
namespace {

// of Okabe and Ito, as base/palette.h
constexpr std::array kDone{"#009e73", "#0072b2", "#56b4e9"};
constexpr std::array kAgain{"#d55e00", "#e69f00", "#cc79a7"};

}  // namespace

std::vector<ChartPainter::Entry> outcomes_of(const task::TaskPlan& plan) {
    std::vector<ChartPainter::Entry> out;
    size_t done = 0, again = 0;
    for (const task::TaskPlan::Outcome& outcome : plan.outcomes) {
        const bool skipped = static_cast<int>(out.size()) == plan.skipped;
        const bool failed = outcome.redo || outcome.ends_session;
        const char* const colour = skipped  ? "#808080"
                                   : failed ? kAgain[again++ % kAgain.size()]
                                            : kDone[done++ % kDone.size()];
        out.push_back({QString::fromStdString(outcome.name), legible(QColor(colour))});
    }
    return out;
}

}  // namespace dihaptic::gui
