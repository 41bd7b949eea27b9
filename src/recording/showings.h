// shown.csv: when the pictures of which ticks came to the screen that the subject looks at; written
// while a session with a window runs. What changed in a tick was seen from the first picture on
// that is of it or of a later one.
#pragma once

#include <fstream>
#include <limits>
#include <vector>

#include "recording/session.h"

namespace dihaptic::recording {

struct Showing {
    int64_t tick = 0;
    double time = 0;  ///< session time when the picture was handed to the screen [s]
};

class ShowingsWriter {
  public:
    explicit ShowingsWriter(const SessionFolder& folder) : file_(folder.file("shown.csv")) {}
    void add(const Showing& showing);
    /// What was added survives the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // made with the first: most sessions have no window
};

class Showings {
  public:
    /// Those of the session; none when it had no window.
    explicit Showings(const SessionFolder& folder);

    bool empty() const { return showings_.empty(); }
    /// When what changed in a tick, at `time` [s], came to the screen [s]; NaN when that took
    /// longer than kSeen, or when no picture came before tick `until`, in which it was gone.
    double onset(int64_t tick, double time, int64_t until = kStays) const;
    static constexpr int64_t kStays = std::numeric_limits<int64_t>::max();
    static constexpr double kSeen = 1;  // [s]

  private:
    std::vector<Showing> showings_;
};

}  // namespace dihaptic::recording
