// Tags from Hierarchical Event Descriptors (HED, www.hedtags.org), which allow programs to compare
// events from different experiments. The export to BIDS writes the tags of each event.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic::task {

/// Reports tags that no HED schema accepts for an event: unbalanced parentheses, a missing comma,
/// an empty or repeated tag, or a character or tag with another meaning. Whether a tag exists
/// depends on the schema; a HED validator checks this in the exported data set.
void check_hed(const std::string& tags, const Place& place, Diagnostics& diagnostics);

}  // namespace dihaptic::task
