// The folder in which a person's session of a rehearsal is made. It belongs to one process at a
// time, and whatever a killed program left in it goes: but only sessions, and never through a link,
// since the rehearsal's folder may be a stranger's.
#pragma once

#include <optional>
#include <string>

namespace dihaptic::session {

/// With this the name of a folder begins in which a person's session is made.
inline constexpr const char* kUnfinished = "unfinished-";

class UnfinishedFolder {
  public:
    /// Makes the folder for a person in that of a rehearsal, or takes over the one that a killed
    /// program left, without its sessions. Returns nullopt while another process has it. Throws
    /// Error when its name is a link's, or when anything is in it that no rehearsal left there.
    static std::optional<UnfinishedFolder> take(const std::string& rehearsal,
                                                const std::string& id);
    ~UnfinishedFolder();
    UnfinishedFolder(UnfinishedFolder&& other) noexcept;
    UnfinishedFolder& operator=(UnfinishedFolder&&) = delete;

    /// Where the session is to be made.
    const std::string& path() const { return path_; }
    /// The file, now empty, to which the process may write what it has to tell [descriptor].
    int messages() const { return messages_; }
    /// Whether the person's session is complete: it may be another program's, and have come just
    /// now. Throws Error as has_session().
    bool is_done() const;
    /// Gives a session that is complete its name. Throws Error when it cannot.
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
    int folder_ = -1;    // held open: a link that takes its name later leads nowhere
    int messages_ = -1;  // locked as long as a process has it
};

/// Whether a rehearsed person's folder is there. Throws Error when anything else has its name,
/// which would keep the person from being done for good.
bool has_session(const std::string& folder);

/// What the process of a person wrote to messages(); "" if there is nothing that can be read.
std::string messages_of(const std::string& rehearsal, const std::string& id);

}  // namespace dihaptic::session
