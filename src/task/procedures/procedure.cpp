#include "task/procedures/procedure.h"

#include <cmath>

#include "base/diagnostics.h"

namespace dihaptic::task {

double Procedure::level() const {
    return std::visit([](const auto& kind) { return kind.level(); }, kind_);
}

void Procedure::answer(double level, bool yes) {
    if (!std::isfinite(level))
        throw Error("a trial's level is not a number", "give the level that was presented");
    if (done())
        throw Error("an answer arrived after the procedure had ended",
                    "run no trials of a procedure after its end");
    std::visit([&](auto& kind) { kind.answer(level, yes); }, kind_);
}

bool Procedure::done() const {
    return std::visit([](const auto& kind) { return kind.done(); }, kind_);
}

Estimate Procedure::estimate() const {
    return std::visit([](const auto& kind) { return kind.estimate(); }, kind_);
}

}  // namespace dihaptic::task
