// Tells tests whether a sanitizer watches them. A tick then takes several milliseconds, so no loop
// on the real clock keeps its rate: a test of timing still runs, for the sanitizer, but judges only
// what does not depend on the machine's speed.
#pragma once

namespace dihaptic::testing {

#ifdef DIHAPTIC_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

}  // namespace dihaptic::testing
