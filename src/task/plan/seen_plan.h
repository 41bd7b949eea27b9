// Plans the visual part of an experiment file: texts with numbers, objects that states hide, looks,
// and the pages before blocks.
#pragma once

#include "task/plan/names.h"

namespace dihaptic::task {

class SeenPlanner : Planning {
  public:
    explicit SeenPlanner(const Planning& given);

    /// Index of a text among the plan's messages, to which a new text is added; -1 if the text is
    /// empty.
    int text(const std::string& text, const Place& place, const char* key);
    /// Plans the display in the state, apart from its message.
    void plan_state(const State& state, TaskPlan::PlannedState& out);
    /// The lines shown while the state asks its question `number`, counted from 1.
    std::vector<int> question(const AskSpec& ask, size_t number, const State& state);
    /// The lines shown while a completed form awaits confirmation.
    std::vector<int> confirmation(const State& state);
    /// Problems with looks themselves go to `found`.
    static void check_looks(const std::vector<LookSpec>& specs, Diagnostics& found);
    /// Adds looks to the existing ones, except those that name only other states.
    void add_looks(const std::vector<LookSpec>& specs, int state, TaskPlan::Looks& out) const;
    static constexpr int kAnyState = -1;
    /// The task's own lines, breaks and pages.
    void plan_task();

  private:
    void show(const Show& given, const Place& place, TaskPlan::PlannedState& out);
    /// Reads which bodies or fingers are shown, given as "name: yes or no"; `first`: index of the
    /// first of them in frames.
    template <class T>
    void show_some(const Node& given, const char* key, size_t first, const Place& place,
                   TaskPlan::Looks& out);
    /// The number with this name; nullopt, with a problem in the diagnostics, if there is none.
    std::optional<TextNumber> number(const std::string& name, const Place& place, const char* key);
    std::vector<int> lines(const std::vector<std::string>& texts, const Place& place);

    size_t bodies_;
    size_t fingers_;
};

/// Whether the text is a valid key: one letter or digit.
bool is_key(const std::string& text);

}  // namespace dihaptic::task
