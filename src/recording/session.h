// The folder that holds a session's files. While the session runs, it contains:
//
//   session.yaml                       participant, time, inputs; state: running
//   scene.yaml rig.yaml settings.yaml  frozen inputs, every default resolved
//   settings.csv                       every setting with its origin
//   raw.log                            every tick
//
// and at its end (or after `dihaptic recover`) also session.nwb, trials.csv, phases.csv,
// episodes.csv and events.csv. The state in session.yaml changes from running last of all, when all
// files exist.
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

/// Something that a study asks its participants besides age, sex and handedness.
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
    int version = 0;          ///< of the study's files
    std::string group;        ///< name, or the code that conceals it
    int number = 0;           ///< of the participant in the group
    std::string session;      ///< name
    std::string condition;    ///< empty: the session has none
    std::vector<Fact> facts;  ///< of the participant

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

/// The state of a table when the session ended.
struct TableSeal {
    std::string file;      ///< name in the session's folder
    int rows = 0;          ///< without its header
    std::string checksum;  ///< CRC-32, in hexadecimal

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required());
        v("rows", rows, Field::number().within(0, INT_MAX));
        v("checksum", checksum, Field::text().required());
    }
};

struct SessionInfo : Setup {
    SessionState state = SessionState::running;
    int ticks = 0;             ///< number of ticks, once the session has ended; 0: not known
    bool interrupted = false;  ///< the session ended early
    std::string program;       ///< name and version
    std::string started;       ///< ISO 8601 with offset
    std::string command;       ///< as typed
    Participant participant;
    std::optional<Participant> partner;  ///< the second participant of a task for two
    std::optional<InStudy> in_study;     ///< none: the session does not belong to a study
    std::string resumes;                 ///< folder of the session that this one resumes
    std::vector<std::string> notes;  ///< warnings given at the start, and findings of the recovery
    std::string finished;            ///< how the session ended, in words
    std::optional<Convergence>
        convergence;                ///< once the session has ended; none before version 0.3
    std::vector<TableSeal> tables;  ///< once the session has ended (recording/seal.h)
    std::string seal;  ///< checksum of this file's own data, once the session has ended

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
    /// Opens a folder that may have no log, only tables made from it, like a rehearsal's.
    static SessionFolder open_tables(const std::string& path);
    /// Makes a new folder in `parent`, named by the time and `name`. Throws Error when this fails.
    static SessionFolder create(const std::string& parent, const std::string& name);

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    std::string raw_log() const { return file("raw.log"); }
    std::string nwb() const { return file("session.nwb"); }

    SessionInfo read_info() const;
    /// Reads the intact part of session.yaml and completes it from `setup`, the log's head; warns
    /// of the losses. Throws Error when the log belongs to another session.
    SessionInfo read_info(const Setup& setup, Diagnostics& diagnostics) const;
    /// Throws Error when the log with this head belongs to a different session from session.yaml.
    void check_log(const SessionInfo& info, const Setup& setup) const;
    /// The session's seed as a number. Throws Error when it is not a whole number.
    uint64_t seed_of(const SessionInfo& info) const;
    /// Writes session.yaml; even after a loss of power, either the old or the new file is there.
    void write_info(const SessionInfo& info) const;
    /// Returns once all files of the folder, their names, and the folder's own name are on the
    /// disk.
    void sync() const;

    /// The current state of a frozen input. Throws Error when it cannot be read.
    InputFile input(const std::string& name) const;
    /// A problem for each input that has changed or is missing.
    std::vector<Problem> changed(const std::vector<InputFile>& inputs, Severity severity) const;

  private:
    static SessionFolder open_with(const std::string& path, const char* file);
    explicit SessionFolder(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

/// A lock held by the program that writes a session's files; a second program cannot obtain it. The
/// lock ends with its program, however the program ends.
class SessionLock {
  public:
    /// Throws Error when another program holds the lock.
    explicit SessionLock(const SessionFolder& folder);

  private:
    Descriptor descriptor_;
};

/// The present time, as ISO 8601 with offset.
std::string iso_now();
/// Name and version of this program, e.g. "dihaptic 0.1.0".
std::string program_version();

}  // namespace dihaptic::recording
