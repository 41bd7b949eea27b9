// Decider lets another program decide between a session's trials: a script that knows what each
// attempt's outcome was, and sets the task's variables, chooses the next trial, or shows a message.
// That program listens on a UNIX socket; the package dihaptic for Python does (docs/python.md).
// It has to be this user's, or root's. Both sides send lines of JSON:
//
//   it       {"messages": ["Slower"]}
//   session  {"session": "sessions/...", "outcomes": [...], "variables": [...], "patience_s": 1}
//   session  {"number": 8, "trial_num": 7, "attempt": 1, "outcome": "hit",
//             "variables": {"force_N": 2}}
//   it       {"number": 8, "set": {"force_N": 1.5}, "next": 12, "message": 0}
//   it       {"number": 8, "failed": "division by zero"}
//
// The first line has what it may show, and comes at once; of an answer's last three keys each may
// be missing.
//
// The question number 1, of trial 0, comes before the first trial. What was decided is recorded as
// values of variables, as the trial that came next and as its message, so that a replay needs
// nobody to decide.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/plan.h"
#include "task/run/between.h"

namespace dihaptic::session {

class Decider {
  public:
    /// Connects, and takes the greeting. Throws Error when nothing listens there, or says anything
    /// else.
    explicit Decider(const std::string& socket);
    ~Decider();
    Decider(const Decider&) = delete;
    Decider& operator=(const Decider&) = delete;

    /// Adds the messages that it may show to the plan's. Throws Error when the plan has no trials.
    void prepare(Plan& plan);
    /// Begins to ask, for a session in that folder. `waits`: its clock is virtual; then `waiting`
    /// is told, from another thread, that the session waits for an answer, and told again.
    void begin(const std::string& folder, bool waits,
               std::function<void(const std::string& what)> waiting = {});
    /// What the director asks; null before begin().
    task::Between* between() const;
    /// Ends it; returns what went wrong, in sentences.
    std::vector<std::string> finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::session
