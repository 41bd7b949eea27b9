// Warns of parts of a task that cannot do what they were written for.
#pragma once

#include "session/plan.h"

namespace dihaptic::session {

/// Warns of conditions that are never met because their state ends before, perturbations that begin
/// after the states in which they act, times below a tick, regions that no device reaches, and
/// factors that nothing uses. Numbers that vary between trials are not checked.
void check_task(const Plan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::session
