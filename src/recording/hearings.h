// Writes and reads heard.csv, which tells when each sound of a session was heard; it is written
// while the session runs.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::recording {

/// A sound that began.
struct Hearing {
    int64_t tick = 0;  ///< that asked for it
    std::string sound;
    double asked = 0;  ///< the tick's session time [s]
    double heard = 0;  ///< session time at which its first sample was heard [s]
};

class HearingsWriter {
  public:
    explicit HearingsWriter(const SessionFolder& folder) : file_(folder.file("heard.csv")) {}
    void add(const Hearing& hearing);
    /// Hands what was added to the system, so that it survives the end of this program.
    void flush() { out_.flush(); }

  private:
    std::string file_;
    std::ofstream out_;  // opened with the first sound
};

/// The session's sounds, in the order in which they were heard; empty if it had none, or if they
/// were not played.
std::vector<Hearing> read_hearings(const SessionFolder& folder);

}  // namespace dihaptic::recording
