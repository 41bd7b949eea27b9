// Writes and reads heard.csv, which contains the time at which each sound of a session was heard.
// The file is written while the session runs.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "base/unmeasured.h"
#include "recording/session.h"

namespace dihaptic::recording {

/// A sound that was heard.
struct Hearing {
    int64_t tick = -1;  ///< tick that requested the sound
    std::string sound;
    double asked = kUnmeasured;  ///< session time of that tick [s]
    double heard = kUnmeasured;  ///< session time at which the sound's first sample was heard [s]

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("tick", f.tick, "1", "tick that requested it");
        v("sound", f.sound, "", "name");
        v("asked", f.asked, "s", "session time of that tick");
        v("heard", f.heard, "s", "session time when its first sample was heard");
    }
};

class HearingsWriter {
  public:
    explicit HearingsWriter(const SessionFolder& folder) : file_(folder.file("heard.csv")) {}
    void add(const Hearing& hearing);
    /// Hands the added rows to the operating system, so that they survive a crash of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened when the first sound is added
};

/// Returns the session's sounds in the order in which they were heard; empty if there were none, or
/// if sounds were not played.
std::vector<Hearing> read_hearings(const SessionFolder& folder);

}  // namespace dihaptic::recording
