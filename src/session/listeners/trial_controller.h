// TrialController lets another program control the course of a session's trials: a script that
// receives the outcome of each attempt and then sets the task's variables, chooses the next trial
// or shows a message. The program must listen on a UNIX socket, as the Python package dihaptic does
// (docs/python.md), and must belong to this user or to root. Both sides send lines of JSON ("it" is
// the program):
//
//   it       {"messages": ["Slower"]}
//   session  {"session": "sessions/...", "outcomes": [...], "variables": [...], "patience_s": 1}
//   session  {"number": 8, "trial_num": 7, "attempt": 1, "outcome": "hit",
//             "variables": {"force_N": 2}}
//   it       {"number": 8, "set": {"force_N": 1.5}, "next": 12, "message": 0}
//   it       {"number": 8, "failed": "division by zero"}
//
// The first line lists the messages that the program may show, and is sent as soon as the session
// connects. In an answer, each of the last three keys may be missing.
//
// Question 1, about trial 0, is asked before the first trial. Decisions are recorded as values of
// variables, as the next trial and as the message shown, so that a replay does not need the
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
    /// Connects to the program and receives its greeting. Throws Error when no program listens on
    /// the socket, or when it sends anything other than a greeting.
    explicit TrialController(const std::string& socket);
    ~TrialController();
    TrialController(const TrialController&) = delete;
    TrialController& operator=(const TrialController&) = delete;

    /// Adds the messages that the program may show to the plan. Throws Error when the plan has no
    /// trials.
    void prepare(Plan& plan);
    /// Starts to ask questions, for a session in this folder. `waits` states whether the session's
    /// clock is virtual; if so, `waiting` is called repeatedly, from another thread, while the
    /// session waits for an answer.
    void begin(const std::string& folder, bool waits,
               std::function<void(const std::string& what)> waiting = {});
    /// The interface through which the director asks its questions; null before begin().
    task::TrialControl* between() const;
    /// Ends the exchange. Returns the faults that occurred, in sentences.
    std::vector<std::string> finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::session
