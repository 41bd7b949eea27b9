#include "experiment/procedures/interleaved.h"

#include <algorithm>

#include "base/diagnostics.h"

namespace dihaptic::experiment {

Interleaved::Interleaved(std::vector<Procedure> tracks, uint64_t seed)
    : tracks_(std::move(tracks)), random_(seed, "interleaved") {
    if (tracks_.empty()) throw Error("there is no track to interleave", "give one or more");
    draw();
}

void Interleaved::answer(double level, bool yes) {
    tracks_[track_].answer(level, yes);
    draw();
}

bool Interleaved::done() const {
    return std::all_of(tracks_.begin(), tracks_.end(), [](const auto& t) { return t.done(); });
}

void Interleaved::draw() {
    std::vector<size_t> open;
    for (size_t i = 0; i < tracks_.size(); ++i)
        if (!tracks_[i].done()) open.push_back(i);
    if (open.empty()) return;
    track_ = open[static_cast<size_t>(random_.uniform(0, static_cast<double>(open.size())))];
}

}  // namespace dihaptic::experiment
