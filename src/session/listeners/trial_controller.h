// TrialController lets another program control the course of a session's trials: a script that
// receives each attempt's outcome, and sets the task's variables, chooses the next trial, or shows
// a message. That program listens on a UNIX socket; the package dihaptic for Python does
// (docs/python.md). It must belong to this user, or to root. Both sides send lines of JSON:
//
//   it       {"messages": ["Slower"]}
//   session  {"session": "sessions/...", "outcomes": [...], "variables": [...], "patience_s": 1}
//   session  {"number": 8, "trial_num": 7, "attempt": 1, "outcome": "hit",
//             "variables": {"force_N": 2}}
//   it       {"number": 8, "set": {"force_N": 1.5}, "next": 12, "message": 0}
//   it       {"number": 8, "failed": "division by zero"}
//
// The first line lists the messages that the program may show, and is sent at once; any of an
// answer's last three keys may be missing.
//
// Question 1, on trial 0, comes before the first trial. Decisions are recorded as values of
// variables, as the next trial and as its message, so that a replay does not need the deciding
// program.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/plan.h"
#include "task/run/trial_control.h"

namespace dihaptic::session {

class TrialController {
  public:
    /// Connects, and receives the greeting. Throws Error when no program listens there, or when it
    /// sends anything else.
    explicit TrialController(const std::string& socket);
    ~TrialController();
    TrialController(const TrialController&) = delete;
    TrialController& operator=(const TrialController&) = delete;

    /// Adds the messages that the program may show to the plan's. Throws Error when the plan has no
    /// trials.
    void prepare(Plan& plan);
    /// Starts asking, for a session in this folder. `waits`: its clock is virtual; then `waiting`
    /// is called from another thread, repeatedly, while the session waits for an answer.
    void begin(const std::string& folder, bool waits,
               std::function<void(const std::string& what)> waiting = {});
    /// The interface for the director's questions; null before begin().
    task::TrialControl* between() const;
    /// Ends the exchange; returns its faults, in sentences.
    std::vector<std::string> finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::session
