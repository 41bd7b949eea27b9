// Writes and reads heard.csv, with the time when each sound of a session was heard. It is written
// while the session runs.
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
    double asked = kUnmeasured;  ///< the tick's session time [s]
    double heard = kUnmeasured;  ///< session time at which its first sample was heard [s]

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
    /// Passes added rows to the system, so that they survive the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first sound
};

/// The session's sounds, in the order in which they were heard; empty if it had none, or if they
/// were not played.
std::vector<Hearing> read_hearings(const SessionFolder& folder);

}  // namespace dihaptic::recording
