// The parts of a task that have different keys depending on their kind (base/kinds.h).
#pragma once

#include "base/kinds.h"
#include "task/file/task.h"

namespace dihaptic::task {

inline Kinds<Exit> kinds_of(const Exit& value) {
    return each_kind<When>("when", value, [](Exit& exit, When when) { exit.when = when; });
}

inline Kinds<LoadSpec> kinds_of(const LoadSpec& value) {
    return each_kind<LoadKind>("kind", value,
                               [](LoadSpec& load, LoadKind kind) { load.kind = kind; });
}

}  // namespace dihaptic::task
