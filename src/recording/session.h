// A session is a folder. While it runs:
//
//   session.yaml                       who, when, with what; state: running
//   scene.yaml rig.yaml settings.yaml  frozen inputs, every default resolved, every setting with
//   its origin raw.log                            every tick
//
// and at its end (or by `dihaptic recover`) session.nwb, trials.csv and events.csv.
#pragma once

#include <string>
#include <vector>

#include "base/field_reader.h"

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

/// A named stretch of a trial, by the session's clock.
struct PhaseInfo {
    std::string name;
    double start = 0;  ///< from the trial's beginning [s]
    double end = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("start", start, Field::of(Quantity::time));
        v("end", end, Field::of(Quantity::time));
    }
};

/// What held a finger, and what its force was limited by.
struct DeviceRecord {
    std::string finger;
    std::string model;
    double peak_force = 0;  ///< [N]

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        v("model", model);
        v("peak_force", peak_force, Field::of(Quantity::force));
    }
};

struct SessionInfo {
    std::string title;
    SessionState state = SessionState::running;
    std::string program;     ///< name and version
    std::string started;     ///< ISO 8601 with offset
    std::string command;     ///< as typed
    std::string experiment;  ///< name of the file
    std::string clock;       ///< virtual or real
    std::string seed;        ///< of everything random
    Participant participant;
    std::string object;  ///< the body that summaries are about
    std::vector<DeviceRecord> devices;
    std::vector<PhaseInfo> phases;   ///< of every trial
    std::vector<std::string> notes;  ///< warnings given at the start
    std::string finished;            ///< what became of it, in words

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title);
        v("state", state);
        v("program", program);
        v("started", started);
        v("command", command);
        v("experiment", experiment);
        v("clock", clock);
        v("seed", seed);
        v("participant", participant);
        v("object", object);
        v("devices", devices);
        v("phases", phases);
        v("notes", notes);
        v("finished", finished);
    }
};

/// Names of the files in a session's folder.
class SessionFolder {
  public:
    /// An existing folder (or a file in it). Throws Error when it is no session.
    static SessionFolder open(const std::string& path);
    /// Makes a new folder in `parent`, named for the time and what is given. Throws Error when it
    /// cannot.
    static SessionFolder create(const std::string& parent, const std::string& name);

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    std::string raw_log() const { return file("raw.log"); }
    std::string nwb() const { return file("session.nwb"); }

    SessionInfo read_info() const;
    void write_info(const SessionInfo& info) const;

  private:
    explicit SessionFolder(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

/// Now, as ISO 8601 with offset.
std::string iso_now();
/// "dihaptic 0.1.0"
std::string program_version();

}  // namespace dihaptic::recording
