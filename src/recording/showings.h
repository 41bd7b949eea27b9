// Writes and reads shown.csv, with the time when each tick's picture appeared on the subject's
// screen. It is written while a session with a window runs. A change in a tick was visible from the
// first picture of that tick or a later one.
#pragma once

#include <fstream>
#include <limits>
#include <vector>

#include "base/unmeasured.h"
#include "recording/session.h"

namespace dihaptic::recording {

struct Showing {
    int64_t tick = -1;
    double time = kUnmeasured;  ///< session time when the picture was handed to the screen [s]

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("tick", f.tick, "1", "tick of the picture");
        v("shown", f.time, "s", "session time when the picture was handed to the screen");
    }
};

class ShowingsWriter {
  public:
    explicit ShowingsWriter(const SessionFolder& folder) : file_(folder.file("shown.csv")) {}
    void add(const Showing& showing);
    /// Passes added rows to the system, so that they survive the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first showing: most sessions have no window
};

class Showings {
  public:
    /// Reads the session's showings; empty if it had no window.
    explicit Showings(const SessionFolder& folder);

    bool empty() const { return showings_.empty(); }
    /// When a change in a tick, at `time` [s], appeared on the screen [s]; NaN if that took longer
    /// than kSeen, or if no picture was shown before tick `until`, at which the change was undone.
    double onset(int64_t tick, double time, int64_t until = kStays) const;
    static constexpr int64_t kStays = std::numeric_limits<int64_t>::max();
    static constexpr double kSeen = 1;  // [s]

  private:
    std::vector<Showing> showings_;
};

}  // namespace dihaptic::recording
