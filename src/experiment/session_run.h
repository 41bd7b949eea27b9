// Runs a plan as a session: from the first tick to a folder with its raw log, complete or not.
#pragma once

#include <atomic>
#include <optional>

#include "experiment/live.h"
#include "experiment/plan.h"
#include "recording/recorder.h"
#include "recording/session.h"
#include "servo/run.h"

namespace dihaptic::experiment {

enum class Clock { virtual_clock, real };

struct RunOptions {
    Clock clock = Clock::virtual_clock;
    std::string out = "sessions";  ///< folder that session folders are made in
    std::string command;           ///< as typed, for the record
    double sync = 0;  ///< how often raw.log is synchronised to the disk [s]; 0: at its end alone
    recording::Participant participant;
    std::atomic<char>* keys = nullptr;  ///< the operator's newest key, until a tick takes it
    /// Called from another thread when a call to the devices never returns, and run_session() thus
    /// cannot either: it has to end the program. Gets what to tell.
    std::function<void(const std::string& message)> stuck;
    /// On active devices, before the first tick and without force: returns what is to be warned of.
    /// What it throws ends the session, of which nothing stays.
    std::function<std::vector<Problem>(devices::DeviceGroup& devices)> check;
    /// The program that owns real devices (keeper::program()): force goes when this one dies. "":
    /// this process owns them.
    std::string keeper;
    /// Virtual clock only: makes what takes the frames in place of raw.log, of which there is none
    /// then. The folder has its frozen inputs.
    std::function<servo::FrameSink(const recording::SessionFolder&, const recording::SessionInfo&,
                                   const recording::LogHead&)>
        in_place_of_log;
    Live* live = nullptr;  ///< real clock only: who watches and steers; outlives the run
};

struct RunResult {
    std::string folder;
    recording::SessionInfo info;  ///< as it is to be once the session's other files are there
    std::optional<recording::SessionLock> lock;  ///< nobody else recovers it until then
    bool interrupted = false;
    double simulated = 0;  ///< session time reached [s]
    double elapsed = 0;    ///< wall time of the ticks [s]
    int64_t ticks = 0;
    int64_t dropped = 0;  ///< frames that the recorder could not take
    servo::Timing timing;
    std::string fault;  ///< why force was switched off, and what to do; empty: it was not
    std::string stall;  ///< what the watchdog did; empty: nothing
};

/// Share of the session done, from 0 to 1; called about ten times a second of wall time.
using Progress = std::function<void(double share)>;

/// Runs to the end of the driver's movement, until `stop`, or until a second after a fault; on the
/// real clock `stop` is the operator's wish, which switches force off at once. Throws Error when
/// the disk gives up; what was written stays and can be recovered. The session's state stays
/// `running`: analysis::finish_session() makes its other files, and it what it is to be.
RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress);

}  // namespace dihaptic::experiment
