// Runs a plan as a session. The result is a folder with the session's raw log, whether or not the
// session was completed.
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
    std::string out = "sessions";  ///< folder in which session folders are created
    std::string command;           ///< command line as typed, stored in the session's record
    double sync = 0;  ///< interval at which raw.log is synchronised to the disk [s]; 0: at its end
    recording::Participant participant;
    recording::Participant partner;  ///< the second participant in a task for two people
    std::optional<recording::InStudy> in_study;
    ValueRing<char>* keys = nullptr;  ///< keys pressed by the operator, until a tick handles them
    /// Called from another thread if a call to the devices never returns, so that run_session()
    /// cannot return either. The function must show the message and end the program.
    std::function<void(const std::string& message)> stuck;
    /// Called from the session's thread before the first tick, with a message about each part that
    /// is missing from the session.
    std::function<void(const std::string& message)> warn;
    /// Called repeatedly, from another thread, with a message that says what the session is waiting
    /// for.
    std::function<void(const std::string& message)> waiting;
    /// Called before the first tick, when the devices are active and force is off; returns
    /// warnings. If the function throws, the session ends and its folder is removed.
    std::function<std::vector<Problem>(devices::DeviceGroup& devices)> check;
    /// For record(), on the virtual clock only: if false, the session writes the same tables but no
    /// raw.log and no session.nwb.
    bool keep_log = true;
    /// On the virtual clock only: creates the sink that receives the frames instead of raw.log,
    /// which is then not written. When the function is called, the folder already contains the
    /// frozen inputs.
    std::function<frame::FrameSink(const recording::SessionFolder&, const recording::SessionInfo&,
                                   const recording::LogHead&)>
        in_place_of_log;
    /// Link to the program that controls the trials. It must have been prepared for the plan and
    /// must outlive the run.
    TrialController* controller = nullptr;
    /// Whether other programs may watch and steer the session (listeners/observers.h).
    bool observers = false;
    Live* live = nullptr;  ///< link to the watching thread; must outlive the run
};

struct RunResult {
    std::string folder;
    recording::SessionInfo info;  ///< its `state` is valid once the other files are written
    std::optional<recording::SessionLock>
        lock;  ///< prevents recovery by other programs until the files are written
    std::optional<recording::SessionLock> earlier;  ///< lock of the session that this one resumes
    bool interrupted = false;
    double simulated = 0;  ///< session time reached [s]
    double elapsed = 0;    ///< wall-clock time taken by the ticks [s]
    int64_t ticks = 0;
    int64_t dropped = 0;  ///< frames that the recorder could not accept
    servo::Timing timing;
    std::string fault;  ///< why force was switched off, with a remedy; empty if it was not
    std::string stall;  ///< what the watchdog did; empty if nothing
    std::vector<std::string> undecided;  ///< failures of the program that controls the trials
};

/// Called about ten times per second of wall-clock time with the completed fraction of the session,
/// from 0 to 1.
using Progress = std::function<void(double share)>;

/// Runs until the driver's movement ends, `stop` becomes true, or one second has passed after a
/// fault. On the real clock, `stop` comes from the operator and switches force off at once. Throws
/// Error when the disk fails; the data written until then remain and can be recovered. The
/// session's state stays `running`: record() writes its other files and sets the final state.
/// `devices` must have been opened for this plan by open_devices(); if null, run_session() opens
/// the devices, and this process owns them.
RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress,
                      std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
