// Tags of the Hierarchical Event Descriptors (HED, www.hedtags.org), by which programs compare
// events of different experiments. The export to BIDS writes them beside each event.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic::task {

/// Reports tags that no HED schema accepts beside an event: with unbalanced parentheses, a missing
/// comma, an empty or a repeated tag, or a character or a tag that has another meaning. Whether a
/// tag exists depends on the schema, which a HED validator of the exported data set knows.
void check_hed(const std::string& tags, const Place& place, Diagnostics& diagnostics);

}  // namespace dihaptic::task
