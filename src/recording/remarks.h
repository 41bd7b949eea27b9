// Writes and reads notes.csv, which contains what the operator noted while a session ran, with the
// time of each note. The file is written while the session runs; events.csv repeats its rows in the
// order of time.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "base/unmeasured.h"
#include "recording/session.h"

namespace dihaptic::recording {

/// A note of the operator. Its time is when the operator began to write it.
struct Remark {
    int64_t tick = -1;          ///< the newest tick then
    double time = kUnmeasured;  ///< session time of that tick [s]
    int trial = 0;              ///< 0: none
    std::string clock;          ///< wall-clock time, as ISO 8601 with offset
    std::string text;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("tick", f.tick, "1", "newest tick when the operator began to write");
        v("time", f.time, "s", "session time of that tick");
        v("trial", f.trial, "1", "trial number, from 1");
        v("clock", f.clock, "", "wall-clock time then, as ISO 8601");
        v("note", f.text, "", "what the operator wrote");
    }
};

class RemarksWriter {
  public:
    explicit RemarksWriter(const SessionFolder& folder) : file_(folder.file("notes.csv")) {}
    /// Hands the row to the operating system, so that it survives a crash of this program.
    void add(const Remark& remark);
    /// Number of notes that could not be written, e.g. because the disk is full.
    int lost() const { return lost_; }

  private:
    std::string file_;
    std::ofstream out_;  // opened when the first note is added
    int lost_ = 0;
};

/// Returns the session's notes in the order in which they were stored; empty if there are none.
std::vector<Remark> read_remarks(const SessionFolder& folder);

/// A note on one line, e.g. "12.3 s, trial 4: coughed".
std::string describe(const Remark& remark);

}  // namespace dihaptic::recording
