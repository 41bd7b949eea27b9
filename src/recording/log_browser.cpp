#include "recording/log_browser.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dihaptic::recording {
namespace {

/// A frame less than this far ahead is reached by reading on rather than by seeking [s].
constexpr double kNear = 0.3;
/// Every chunk contains one frame that lists all bodies (recorder.h). In a log written by the
/// recorder's thread, this need not be the chunk's first frame, so reading starts this many chunks
/// earlier.
constexpr size_t kBefore = 2;

}  // namespace

LogBrowser::LogBrowser(const std::string& file)
    : reader_(file),
      scout_(file),
      chunks_(scout_.places()),
      times_(chunks_.size(), std::numeric_limits<double>::quiet_NaN()) {
    go_to(0);
    if (ahead_ == nullptr) throw Error({file, 0}, "", "has no frame", "Give another session.");
    begin_ = end_ = seconds(ahead_->time);
    take();
    // if the last chunk cannot be read, an earlier one determines the end
    for (size_t k = chunks_.size(); k-- > 0 && end_ == begin_;) {
        scout_.go_to(chunks_[k]);
        while (const frame::Frame* frame = scout_.next()) end_ = seconds(frame->time);
    }
}

double LogBrowser::time_of(size_t chunk) {
    double& time = times_[chunk];
    if (std::isnan(time)) {
        scout_.go_to(chunks_[chunk]);
        const frame::Frame* const frame = scout_.next();
        time = frame == nullptr ? std::numeric_limits<double>::infinity() : seconds(frame->time);
    }
    return time;
}

/// Returns the index of the last chunk that begins at or before a time.
size_t LogBrowser::chunk_at(double time) {
    size_t low = 0, high = chunks_.size();
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        (time_of(middle) <= time ? low : high) = middle;
    }
    return low;
}

const frame::Frame& LogBrowser::at(double time) {
    const auto is_past = [&](const frame::Frame& frame) { return seconds(frame.time) > time; };
    if (is_past(now_) || time > seconds(now_.time) + kNear) {
        const size_t chunk = chunk_at(time);
        go_to(chunk - std::min(chunk, kBefore));
        if (ahead_ == nullptr) return now_;
        take();
    }
    while (ahead_ != nullptr && !is_past(*ahead_)) take();
    return now_;
}

const frame::Frame* LogBrowser::next() {
    if (ahead_ == nullptr) return nullptr;
    take();
    return &now_;
}

void LogBrowser::go_to(size_t chunk) {
    chunk_ = chunk;
    ahead_ = nullptr;
    if (chunk_ == chunks_.size()) return;
    reader_.go_to(chunks_[chunk_++]);
    read_on();
}

void LogBrowser::take() {
    now_ = *ahead_;
    read_on();
}

/// Reads the next frame, moving on to later chunks at the end of this one.
void LogBrowser::read_on() {
    ahead_ = reader_.next();
    while (ahead_ == nullptr && chunk_ < chunks_.size()) {
        reader_.go_to(chunks_[chunk_++], true);
        ahead_ = reader_.next();
    }
}

}  // namespace dihaptic::recording
