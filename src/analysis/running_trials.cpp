#include "analysis/running_trials.h"

#include "analysis/trials.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {

RunningTrials::RunningTrials(const std::string& folder)
    : folder_(recording::SessionFolder::open(folder)), info_(folder_.read_info()) {
    if (!has_trials(folder_))
        throw Error({folder, 0}, "", "has no trials", "Name a session with a task.");
}

void RunningTrials::look() {
    recording::RawLogReader log(folder_.raw_log());  // anew: the file has grown
    if (!reader_) reader_.emplace(folder_, info_, log.head());
    const auto chunks = log.places();
    for (bool follows = false; read_ < chunks.size(); follows = true) {
        log.go_to(chunks[read_], follows);
        const servo::Frame* frame = log.next();
        if (frame == nullptr) return;  // the chunk is being written
        for (; frame != nullptr; frame = log.next()) reader_->add(*frame);
        ++read_;
    }
}

Table RunningTrials::table() const {
    return reader_ ? reader_->trials() : Table{};
}

size_t RunningTrials::ended() const {
    return reader_ ? reader_->ended_trials() : 0;
}

}  // namespace dihaptic::analysis
