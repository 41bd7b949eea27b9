// Runs a plan as a session: from the first tick to a folder with its raw log, complete or not.
#pragma once

#include <atomic>
#include <optional>

#include "base/ring.h"
#include "recording/raw_log.h"
#include "recording/session.h"
#include "servo/run.h"
#include "session/listeners/live.h"
#include "session/plan.h"

namespace dihaptic::session {

class TrialController;

enum class Clock { virtual_clock, real };

struct RunOptions {
    Clock clock = Clock::virtual_clock;
    std::string out = "sessions";  ///< folder in which session folders are made
    std::string command;           ///< command line as typed, for the record
    double sync = 0;  ///< interval at which raw.log is synchronised to the disk [s]; 0: at its end
    recording::Participant participant;
    recording::Participant partner;  ///< the second participant of a task for two
    std::optional<recording::InStudy> in_study;
    ValueRing<char>* keys = nullptr;  ///< the operator's keys, until a tick takes them
    /// Called from another thread when a call to the devices never returns, so that run_session()
    /// cannot return either. It must show the message and end the program.
    std::function<void(const std::string& message)> stuck;
    /// Called from the session's thread, before the first tick, with a message about each part that
    /// the session lacks.
    std::function<void(const std::string& message)> warn;
    /// Called from another thread, repeatedly, with a message about the session's wait.
    std::function<void(const std::string& message)> waiting;
    /// Called on active devices, before the first tick and with the force off; returns warnings. An
    /// exception from it ends the session, and its folder is removed.
    std::function<std::vector<Problem>(devices::DeviceGroup& devices)> check;
    /// For record(), on the virtual clock only: when false, the session has no raw.log and no
    /// session.nwb, but the same tables.
    bool keep_log = true;
    /// Virtual clock only: makes the sink that receives the frames in place of raw.log, which is
    /// then not written. The folder already contains its frozen inputs.
    std::function<frame::FrameSink(const recording::SessionFolder&, const recording::SessionInfo&,
                                   const recording::LogHead&)>
        in_place_of_log;
    /// Link to the program that controls the trials; prepared for the plan, and must outlive the
    /// run.
    TrialController* controller = nullptr;
    /// Whether other programs may watch and steer the session (listeners/observers.h).
    bool observers = false;
    Live* live = nullptr;  ///< link to the watching thread; must outlive the run
};

struct RunResult {
    std::string folder;
    recording::SessionInfo info;  ///< its `state` holds once the session's other files are written
    std::optional<recording::SessionLock>
        lock;  ///< keeps other programs from recovering the session until then
    std::optional<recording::SessionLock> earlier;  ///< lock on the session that this one resumes
    bool interrupted = false;
    double simulated = 0;  ///< session time reached [s]
    double elapsed = 0;    ///< wall time of the ticks [s]
    int64_t ticks = 0;
    int64_t dropped = 0;  ///< frames that the recorder could not accept
    servo::Timing timing;
    std::string fault;  ///< reason why force was switched off, with a remedy; empty if it was not
    std::string stall;  ///< action of the watchdog; empty if none
    std::vector<std::string> undecided;  ///< failures of the program that controls the trials
};

/// Receives the completed share of the session, from 0 to 1, about ten times per second of wall
/// time.
using Progress = std::function<void(double share)>;

/// Runs to the end of the driver's movement, until `stop`, or until a second after a fault. On the
/// real clock `stop` comes from the operator and switches force off at once. Throws Error when the
/// disk fails; written data remain and can be recovered. The session's state stays `running`:
/// record() makes its other files and sets the final state. `devices`: those that open_devices()
/// opened for this plan; null: opens them, owned by this process.
RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress,
                      std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
