// Writes and reads shown.csv, which contains the time when each tick's picture appeared on the
// subject's screen. The file is written while a session with a window runs. A change in a tick
// became visible with the first picture of that tick or of a later tick.
#pragma once

#include <fstream>
#include <limits>
#include <vector>

#include "base/unmeasured.h"
#include "recording/session.h"

namespace dihaptic::recording {

struct Showing {
    int64_t tick = -1;
    double time = kUnmeasured;  ///< session time when the picture was passed to the screen [s]

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
    /// Hands the added rows to the operating system, so that they survive a crash of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened when the first row is added, because most sessions have no window
};

class Showings {
  public:
    /// Reads the showings of the session; there are none if the session had no window.
    explicit Showings(const SessionFolder& folder);

    bool empty() const { return showings_.empty(); }
    /// Returns the time when a change made in tick `tick`, at `time` [s], appeared on the screen
    /// [s]. Returns NaN if this took longer than kSeen, or if no picture was shown before tick
    /// `until`, in which the change was undone.
    double onset(int64_t tick, double time, int64_t until = kStays) const;
    static constexpr int64_t kStays = std::numeric_limits<int64_t>::max();
    static constexpr double kSeen = 1;  // [s]

  private:
    std::vector<Showing> showings_;
};

}  // namespace dihaptic::recording
