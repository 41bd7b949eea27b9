// The folder in which a person's session in a rehearsal is created. Only one process at a time can
// hold it. Sessions left in the folder by a killed program are removed, but nothing other than
// sessions, and never through a link, since the rehearsal's folder may come from a stranger.
#pragma once

#include <optional>
#include <string>

#include "base/descriptor.h"

namespace dihaptic::session {

/// Prefix of the names of folders in which a person's session is created.
inline constexpr const char* kUnfinished = "unfinished-";

class UnfinishedFolder {
  public:
    /// Creates the folder for a person in a rehearsal's folder, or takes over the one left by a
    /// killed program, after removing the sessions in it. Returns nullopt while another process
    /// holds the folder. Throws Error if its name belongs to a link, or if the folder contains
    /// anything that a rehearsal would not have left there.
    static std::optional<UnfinishedFolder> take(const std::string& rehearsal,
                                                const std::string& id);

    /// The path at which the session is to be created.
    const std::string& path() const { return path_; }
    /// Descriptor of the file for the process's messages, which is empty at first.
    int messages() const { return messages_.get(); }
    /// Whether the person's session is complete, e.g. because another program has just completed
    /// it. Throws Error like has_session().
    bool is_done() const;
    /// Moves a completed session to its final name. Throws Error when this fails.
    void finish(const std::string& session) const;
    /// Removes the folder and the sessions in it.
    void remove() const;

  private:
    UnfinishedFolder(const std::string& rehearsal, const std::string& id);
    bool lock();
    void remove_sessions() const;

    std::string id_;
    std::string done_;
    std::string path_;
    Descriptor folder_;    // kept open, so that a link that later takes its name has no effect
    Descriptor messages_;  // locked as long as a process holds the folder
};

/// Whether the folder of a simulated person exists. Throws Error if anything else has its name,
/// which would permanently block this person.
bool has_session(const std::string& folder);

/// Returns the text that a person's process wrote to messages(); "" if it cannot be read.
std::string messages_of(const std::string& rehearsal, const std::string& id);

}  // namespace dihaptic::session
