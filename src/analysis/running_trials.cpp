#include "analysis/running_trials.h"

#include "analysis/trials.h"

namespace dihaptic::analysis {

RunningTrials::RunningTrials(const std::string& folder)
    : folder_(recording::SessionFolder::open(folder)), info_(folder_.read_info()) {
    if (!has_trials(folder_))
        throw Error({folder, 0}, "", "has no trials", "Name a session with a task.");
}

void RunningTrials::look() {
    if (!log_) {
        log_.emplace(folder_.raw_log());
        reader_.emplace(folder_, info_, log_->head());
    }
    while (const auto chunk = log_->following(last_ ? &*last_ : nullptr)) {
        log_->go_to(*chunk, last_.has_value());
        while (const frame::Frame* frame = log_->next()) reader_->add(*frame);
        last_ = chunk;
    }
}

Table RunningTrials::table() const {
    return reader_ ? reader_->trials() : Table{};
}

size_t RunningTrials::ended() const {
    return reader_ ? reader_->ended_trials() : 0;
}

}  // namespace dihaptic::analysis
