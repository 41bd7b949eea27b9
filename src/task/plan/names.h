// The things in a task that names can refer to.
#pragma once

#include <tuple>

#include "task/plan/each.h"
#include "task/plan/lookup.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// The names of all things of one kind.
template <class T>
struct Known {
    std::vector<std::string> names;
    const char* unknown;  ///< predicate of the error message for an unknown name
};

class Names {
  public:
    Names(const Task& task, const scene::Scene& scene);

    template <class T>
    const std::vector<std::string>& all() const {
        return std::get<Known<T>>(known_).names;
    }
    /// Returns the index of the T with this name. If there is none, returns -1 and reports an
    /// error.
    template <class T>
    int find(const std::string& name, const Place& place, std::string_view key,
             Diagnostics& diagnostics) const {
        return look_up(all<T>(), name, place, std::string(key), std::get<Known<T>>(known_).unknown,
                       diagnostics);
    }
    /// Returns the index of the T that `ref` refers to. If the name is missing, returns -1 and
    /// reports an error. Unknown names are reported by resolve().
    template <class T>
    int need(const Ref<T>& ref, const Place& place, std::string_view key,
             Diagnostics& diagnostics) const {
        return ref.empty() ? find<T>(ref, place, key, diagnostics) : ref.index;
    }

  private:
    std::tuple<Known<Hand>, Known<Region>, Known<scene::Body>, Known<scene::Joint>,
               Known<scene::Finger>, Known<Thing>, Known<State>, Known<SoundSpec>, Known<Condition>,
               Known<PerturbationSpec>, Known<ProcedureSpec>, Known<Variable>>
        known_;
};

/// The data shared by all parts of planning.
struct Planning {
    /// Contains the task with its references resolved, and the parts planned so far.
    TaskPlan& plan;
    const Names& names;
    const scene::Scene& scene;
    Diagnostics& diagnostics;
};

/// Looks up all references in a part of a task. Reports an error for each unknown name.
template <class Struct>
void resolve(Struct& value, const Names& names, Diagnostics& diagnostics) {
    const auto one = [&]<class T>(Ref<T>& ref, std::string_view key, const Place& place) {
        if (!ref.empty()) ref.index = names.find<T>(ref, place, key, diagnostics);
    };
    const auto several = [&]<class T, class List>(Refs<T, List>& refs, std::string_view key,
                                                  const Place& place) {
        refs.indices.clear();
        for (const std::string& name : refs) {
            const int i = names.find<T>(name, place, key, diagnostics);
            if (i >= 0) refs.indices.push_back(i);
        }
    };
    each(value, Overloaded{one, several});
}

}  // namespace dihaptic::task
