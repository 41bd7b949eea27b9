// The folder that holds a session's files. While the session runs, it contains:
//
//   session.yaml                       participant, time, inputs; state: running
//   scene.yaml rig.yaml settings.yaml  frozen inputs, every default resolved
//   settings.csv                       every setting with its origin
//   raw.log                            every tick
//
// When the session has ended (or after `dihaptic recover`), the folder also contains session.nwb,
// trials.csv, phases.csv, episodes.csv and events.csv. The state in session.yaml remains "running"
// until all files exist.
#pragma once

#include <climits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptor.h"
#include "base/field.h"
#include "recording/convergence.h"
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
        v("age", age, Field::number().at_least(0));
        v("sex", sex);
        v("handedness", handedness);
    }
};

/// Something that a study records about its participants besides age, sex and handedness.
struct Fact {
    std::string name;
    std::string value;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("value", value, Field::text().required());
    }
};

/// The place of a session in a study.
struct InStudy {
    std::string study;        ///< title
    int version = 0;          ///< version of the study's files
    std::string group;        ///< name of the group, or the code that conceals it
    int number = 0;           ///< number of the participant within the group
    std::string session;      ///< name
    std::string condition;    ///< empty if the session has no condition
    std::vector<Fact> facts;  ///< facts about the participant

    template <class Visitor>
    void visit(Visitor& v) {
        v("study", study);
        v("version", version);
        v("group", group);
        v("number", number);
        v("session", session);
        v("condition", condition);
        v("facts", facts);
    }
};

/// The state of a table at the end of its session.
struct TableSeal {
    std::string file;      ///< name in the session's folder
    int rows = 0;          ///< number of rows, not counting the header
    std::string checksum;  ///< CRC-32 in hexadecimal

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required());
        v("rows", rows, Field::number().within(0, INT_MAX));
        v("checksum", checksum, Field::text().required());
    }
};

struct SessionInfo : Setup {
    SessionState state = SessionState::running;
    int ticks = 0;             ///< number of ticks, set once the session has ended; 0 if unknown
    bool interrupted = false;  ///< whether the session ended early
    std::string program;       ///< name and version of the program
    std::string started;       ///< start time, as ISO 8601 with offset
    std::string command;       ///< as typed
    Participant participant;
    std::optional<Participant> partner;  ///< the second participant in a task for two people
    std::optional<InStudy> in_study;     ///< unset if the session does not belong to a study
    std::string resumes;                 ///< folder of the session that this one resumes
    std::vector<std::string> notes;  ///< warnings given at the start, and results of the recovery
    std::string finished;            ///< how the session ended, in words
    std::optional<Convergence>
        convergence;                ///< set once the session has ended; missing before version 0.3
    std::vector<TableSeal> tables;  ///< set once the session has ended (recording/seal.h)
    std::string seal;  ///< checksum of this file's own data, set once the session has ended

    template <class Visitor>
    void visit(Visitor& v) {
        v("state", state);
        v("ticks", ticks);
        v("interrupted", interrupted);
        v("program", program);
        v("started", started);
        v("command", command);
        v("participant", participant);
        v("partner", partner);
        v("in_study", in_study);
        v("resumes", resumes);
        Setup::visit(v);
        v("notes", notes);
        v("finished", finished);
        v("convergence", convergence);
        v("tables", tables);
        v("seal", seal);
    }
};

/// A session's folder, with the names of its files.
class SessionFolder {
  public:
    /// Opens an existing folder, given by its path or by a file in it. Throws Error when it is not
    /// a session.
    static SessionFolder open(const std::string& path);
    /// Opens a folder that may lack a log and contain only tables, like a rehearsal's folder.
    static SessionFolder open_tables(const std::string& path);
    /// Creates a new folder in `parent`; its name consists of the current time and `name`. Throws
    /// Error when this fails.
    static SessionFolder create(const std::string& parent, const std::string& name);

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    std::string raw_log() const { return file("raw.log"); }
    std::string nwb() const { return file("session.nwb"); }

    SessionInfo read_info() const;
    /// Reads the intact part of session.yaml, completes it from `setup`, which is stored in the
    /// log's head, and warns about what was lost. Throws Error when the log belongs to another
    /// session.
    SessionInfo read_info(const Setup& setup, Diagnostics& diagnostics) const;
    /// Throws Error if session.yaml and the log with this head belong to different sessions.
    void check_log(const SessionInfo& info, const Setup& setup) const;
    /// Returns the session's seed as a number. Throws Error when the seed is not a whole number.
    uint64_t seed_of(const SessionInfo& info) const;
    /// Writes session.yaml. Even after a power failure, either the old or the new file exists.
    void write_info(const SessionInfo& info) const;
    /// Returns once all files in the folder, their names, and the name of the folder itself are on
    /// the disk.
    void sync() const;

    /// Returns the current state of a frozen input. Throws Error when the input cannot be read.
    InputFile input(const std::string& name) const;
    /// Returns a problem for each input that has changed or is missing.
    std::vector<Problem> changed(const std::vector<InputFile>& inputs, Severity severity) const;

  private:
    static SessionFolder open_with(const std::string& path, const char* file);
    explicit SessionFolder(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

/// A lock held by the program that writes a session's files, which no second program can obtain.
/// The lock is released when its program ends for whatever reason.
class SessionLock {
  public:
    /// Throws Error when another program holds the lock.
    explicit SessionLock(const SessionFolder& folder);

  private:
    Descriptor descriptor_;
};

/// Returns the current time as ISO 8601 with offset.
std::string iso_now();
/// Returns the name and version of this program, e.g. "dihaptic 0.1.0".
std::string program_version();

}  // namespace dihaptic::recording
