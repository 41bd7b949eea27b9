// The role that a trial has in the analysis.
#pragma once

#include <array>

#include "base/field.h"

namespace dihaptic::rows {

/// In a visual_clamp, the displayed hand cannot deviate, while the real hand moves freely. In a
/// force_channel, the hand is held to a line, and the force with which it presses sideways is
/// measured.
enum class TrialKind {
    practice,
    baseline,
    perturbed,
    catch_trial,
    visual_clamp,
    force_channel,
    washout
};
constexpr auto enum_names(TrialKind) {
    return std::array{"practice",     "baseline",      "perturbed", "catch",
                      "visual_clamp", "force_channel", "washout"};
}
/// The old name of both kinds of clamp in the files and recordings of earlier versions.
constexpr OldName old_name(TrialKind) {
    return {"error_clamp",
            "Write visual_clamp if the displayed hand follows a line (toward), or force_channel if "
            "the hand is held to one."};
}
/// The kind that replaces the old name when a table is read. The trial was in fact a force_channel
/// if a force channel acted in it (analysis/perturbations.h).
constexpr TrialKind old_value(TrialKind) {
    return TrialKind::visual_clamp;
}

/// Whether no error is visible in trials of this kind.
constexpr bool is_clamp(TrialKind kind) {
    return kind == TrialKind::visual_clamp || kind == TrialKind::force_channel;
}

}  // namespace dihaptic::rows
