// A session is a folder. While it runs:
//
//   session.yaml                       who, when, with what; state: running
//   scene.yaml rig.yaml settings.yaml  frozen inputs, every default resolved
//   settings.csv                       every setting with its origin
//   raw.log                            every tick
//
// and at its end (or by `dihaptic recover`) session.nwb, trials.csv, phases.csv, episodes.csv
// and events.csv.
// Last of all session.yaml gets another state than running: then all of them are there.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "recording/setup.h"

namespace dihaptic::recording {

enum class SessionState { running, complete, interrupted, recovered };
constexpr auto enum_names(SessionState) {
    return std::array{"running", "complete", "interrupted", "recovered"};
}

struct Participant {
    std::string id;
    std::string age;         ///< years
    std::string sex;         ///< F, M, O, or U for unknown
    std::string handedness;  ///< right, left, both

    template <class Visitor>
    void visit(Visitor& v) {
        v("id", id);
        v("age", age);
        v("sex", sex);
        v("handedness", handedness);
    }
};

struct SessionInfo : Setup {
    SessionState state = SessionState::running;
    int ticks = 0;             ///< that the session had, once it ended; 0: not known
    bool interrupted = false;  ///< ended before its time
    std::string program;       ///< name and version
    std::string started;       ///< ISO 8601 with offset
    std::string command;       ///< as typed
    Participant participant;
    std::string resumes;             ///< folder of the session that this one goes on with
    std::vector<std::string> notes;  ///< warnings given at the start, and what recovering found
    std::string finished;            ///< what became of it, in words

    template <class Visitor>
    void visit(Visitor& v) {
        v("state", state);
        v("ticks", ticks);
        v("interrupted", interrupted);
        v("program", program);
        v("started", started);
        v("command", command);
        v("participant", participant);
        v("resumes", resumes);
        Setup::visit(v);
        v("notes", notes);
        v("finished", finished);
    }
};

/// Names of the files in a session's folder.
class SessionFolder {
  public:
    /// An existing folder (or a file in it). Throws Error when it is no session.
    static SessionFolder open(const std::string& path);
    /// The same of one that may have no log any more, only what was made of it: a rehearsal's.
    static SessionFolder open_tables(const std::string& path);
    /// Makes a new folder in `parent`, named for the time and what is given. Throws Error when it
    /// cannot.
    static SessionFolder create(const std::string& parent, const std::string& name);

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    std::string raw_log() const { return file("raw.log"); }
    std::string nwb() const { return file("session.nwb"); }

    SessionInfo read_info() const;
    /// What is left of session.yaml, completed from the log's head; what that cannot tell is warned
    /// of. Throws Error when the log is of another session.
    SessionInfo read_info(const Setup& setup, Diagnostics& diagnostics) const;
    /// Throws Error when that log is of another session than session.yaml.
    void check_log(const SessionInfo& info, const Setup& setup) const;
    /// The seed of its info. Throws Error when it is no whole number.
    uint64_t seed_of(const SessionInfo& info) const;
    /// After a loss of power too there is the old one or the new.
    void write_info(const SessionInfo& info) const;
    /// Returns once all of its files are on the disk, and their names, and its own.
    void sync() const;

    /// A frozen input as it is now; throws Error when it cannot be read.
    InputFile input(const std::string& name) const;
    /// Which of the inputs are no longer what they were, or gone: a problem each.
    std::vector<Problem> changed(const std::vector<InputFile>& inputs, Severity severity) const;

  private:
    static SessionFolder open_with(const std::string& path, const char* file);
    explicit SessionFolder(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

/// Held by the program that writes a session's files: a second one is refused. It ends with its
/// program, however that ends.
class SessionLock {
  public:
    /// Throws Error when another program has it.
    explicit SessionLock(const SessionFolder& folder);
    ~SessionLock();
    SessionLock(SessionLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    SessionLock& operator=(SessionLock&& other) noexcept;

  private:
    int descriptor_ = -1;
};

/// Now, as ISO 8601 with offset.
std::string iso_now();
/// "dihaptic 0.1.0"
std::string program_version();

}  // namespace dihaptic::recording
