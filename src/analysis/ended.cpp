#include "analysis/ended.h"

#include "base/regular_file.h"
#include "base/shell_word.h"

namespace dihaptic::analysis {

void check_ended(const recording::SessionFolder& session, const recording::SessionInfo& info) {
    if (info.state == recording::SessionState::running) {
        throw Error({session.file("session.yaml"), 0}, "", "the session has not ended",
                    "If it was killed, run: dihaptic recover " + shell_file(session.path()));
    }
    if (!is_there(session.raw_log()) && is_there(session.file("trials.csv"))) {
        throw Error({session.path(), 0}, "", "has no recording any more, only tables",
                    "Rehearse with --keep-recordings to keep it.");
    }
}

}  // namespace dihaptic::analysis
