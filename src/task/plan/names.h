// The things to which names in a task can refer.
#pragma once

#include <tuple>

#include "task/plan/each.h"
#include "task/plan/lookup.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// All named things of one kind.
template <class T>
struct Known {
    std::vector<std::string> names;
    const char* unknown;  ///< predicate in the error for an unknown name
};

class Names {
  public:
    Names(const Task& task, const scene::Scene& scene);

    template <class T>
    const std::vector<std::string>& all() const {
        return std::get<Known<T>>(known_).names;
    }
    /// Index of the T with this name, or -1 with an error.
    template <class T>
    int find(const std::string& name, const Place& place, std::string_view key,
             Diagnostics& diagnostics) const {
        return look_up(all<T>(), name, place, std::string(key), std::get<Known<T>>(known_).unknown,
                       diagnostics);
    }
    /// Index of the T in question; -1, with an error, if the name is missing. resolve() reports
    /// unknown names.
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

/// The shared data of all parts of planning.
struct Planning {
    TaskPlan& plan;  ///< has the task, its references resolved, and the parts planned so far
    const Names& names;
    const scene::Scene& scene;
    Diagnostics& diagnostics;
};

/// Looks up all references in a part of a task. Unknown names are errors.
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
