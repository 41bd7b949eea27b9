// Plans the visual part of an experiment file: texts that contain numbers, objects that states
// hide, looks, and the pages shown before blocks.
#pragma once

#include "task/plan/names.h"

namespace dihaptic::task {

class SeenPlanner : Planning {
  public:
    explicit SeenPlanner(const Planning& given);

    /// Returns the index of a text among the plan's messages, adding the text if it is new. Returns
    /// -1 if the text is empty.
    int text(const std::string& text, const Place& place, const char* key);
    /// Plans everything displayed in the state except its message.
    void plan_state(const State& state, TaskPlan::PlannedState& out);
    /// Returns the lines shown while the state asks its question `number`, counted from 1.
    std::vector<int> question(const AskSpec& ask, size_t number, const State& state);
    /// Returns the lines shown while a completed form awaits confirmation.
    std::vector<int> confirmation(const State& state);
    /// Checks looks by themselves. Problems are added to `found`.
    static void check_looks(const std::vector<LookSpec>& specs, Diagnostics& found);
    /// Adds looks to the existing ones, except for those that apply only to other states.
    void add_looks(const std::vector<LookSpec>& specs, int state, TaskPlan::Looks& out) const;
    static constexpr int kAnyState = -1;
    /// Plans the lines, breaks and pages of the task itself.
    void plan_task();

  private:
    void show(const Show& given, const Place& place, TaskPlan::PlannedState& out);
    /// Reads which bodies or fingers are shown from a mapping of the form "name: yes or no".
    /// `first` is the index in frames of the first body or finger.
    template <class T>
    void show_some(const Node& given, const char* key, size_t first, const Place& place,
                   TaskPlan::Looks& out);
    /// Returns the number with this name. If there is none, adds a problem to the diagnostics and
    /// returns nullopt.
    std::optional<TextNumber> number(const std::string& name, const Place& place, const char* key);
    std::vector<int> lines(const std::vector<std::string>& texts, const Place& place);

    size_t bodies_;
    size_t fingers_;
};

/// Whether the text is a valid key, i.e. a single letter or digit.
bool is_key(const std::string& text);

}  // namespace dihaptic::task
