// The folder in which a person's session in a rehearsal is made. It belongs to one process at a
// time, and sessions left in it by a killed program are removed: only sessions, and never through a
// link, since the rehearsal's folder may come from a stranger.
#pragma once

#include <optional>
#include <string>

#include "base/descriptor.h"

namespace dihaptic::session {

/// Prefix of the name of a folder in which a person's session is made.
inline constexpr const char* kUnfinished = "unfinished-";

class UnfinishedFolder {
  public:
    /// Makes the folder for a person in a rehearsal's folder, or takes over the one left by a
    /// killed program, without its sessions. Returns nullopt while another process holds it. Throws
    /// Error when its name is a link, or when it contains anything that no rehearsal left.
    static std::optional<UnfinishedFolder> take(const std::string& rehearsal,
                                                const std::string& id);

    /// The path at which the session is to be made.
    const std::string& path() const { return path_; }
    /// The file, now empty, for the process's messages [descriptor].
    int messages() const { return messages_.get(); }
    /// Whether the person's session is complete: another program may have just completed it. Throws
    /// Error like has_session().
    bool is_done() const;
    /// Gives a completed session its name. Throws Error when this fails.
    void finish(const std::string& session) const;
    /// Removes the folder, with the sessions in it.
    void remove() const;

  private:
    UnfinishedFolder(const std::string& rehearsal, const std::string& id);
    bool lock();
    void remove_sessions() const;

    std::string id_;
    std::string done_;
    std::string path_;
    Descriptor folder_;    // held open: a link that takes its name later has no effect
    Descriptor messages_;  // locked as long as a process has it
};

/// Whether a rehearsed person's folder exists. Throws Error when anything else has its name, which
/// would permanently block this person.
bool has_session(const std::string& folder);

/// The text that a person's process wrote to messages(); "" if none can be read.
std::string messages_of(const std::string& rehearsal, const std::string& id);

}  // namespace dihaptic::session
