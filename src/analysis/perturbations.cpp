#include "analysis/perturbations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/field_reader.h"
#include "base/regular_file.h"
#include "base/unit.h"
#include "task/effects/factor.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis {
namespace {

/// The course of a perturbation within a trial, in words.
void say_course(const task::Profile& profile, std::vector<std::string>& out) {
    const auto ms = [](const Formula& time) {
        return task::in_words(time, 1e-3) + (time.computed() ? "" : " ms");
    };
    if (profile.delay != 0) out.push_back("after " + ms(profile.delay));
    if (profile.rise != 0) out.push_back("rising in " + ms(profile.rise));
    if (profile.plateau) out.push_back("full for " + ms(*profile.plateau));
    if (profile.plateau && profile.fall != 0) out.push_back("falling in " + ms(profile.fall));
}

/// The kind of the perturbation and its size.
std::string kind_and_size(const task::PerturbationSpec& perturbation) {
    std::vector<std::string> out;
    perturbation.each_effect([&](const auto& effect) { say(effect, out); });
    if (out.empty()) return "no effect";
    if (perturbation.profile) say_course(*perturbation.profile, out);
    return fmt::format("{}", fmt::join(out, "; "));
}

/// Returns a description of the perturbation if its learning is not measured, otherwise "".
std::string what_of(const task::PerturbationSpec& perturbation) {
    std::string loads;
    for (const task::LoadSpec& load : perturbation.all_loads()) {
        if (load.kind != task::LoadKind::channel)
            return "a force field (" + std::string(enum_name(load.kind)) + ")";
        loads = kForceChannel;
    }
    if (!loads.empty()) return loads;
    if (!perturbation.body) return "";
    const FormulaVec3& scale = perturbation.body->mass_scale;
    const bool same = scale[1] == scale[0] && scale[2] == scale[0];
    return same ? "" : "a mass that differs by direction";
}

void collect(const std::vector<task::PerturbationSpec>& perturbations, Unmeasured& out) {
    for (const task::PerturbationSpec& perturbation : perturbations) {
        const std::string what = what_of(perturbation);
        if (!perturbation.name.empty() && !what.empty()) out[perturbation.name] = what;
    }
}

}  // namespace

task::Task read_frozen_task(const std::string& file) {
    if (!is_there(file)) return {};
    task::Task task;
    try {
        Diagnostics ignored(UnknownKeys::are_left_out);  // the part that is readable is sufficient
        read_fields(task, read_yaml(file), ignored);
    } catch (const Error&) {
        return {};
    }
    return task;
}

std::string column_of_errors(const task::Task& task) {
    if (!task.movement || task.movement->error.empty()) return "";
    return task::error_column(task.measures, task.movement->error);
}

Unmeasured unmeasured_perturbations(const task::Task& task) {
    Unmeasured out;
    collect(task.perturbations, out);
    // also list the replacements in rounds and conditions
    for (const auto* list : {&task.rounds, &task.conditions}) {
        for (const task::Condition& condition : *list) collect(condition.perturbations, out);
    }
    return out;
}

Table perturbation_table(const task::Task& task) {
    Table out{{{"perturbation", ""}, {"in", "round or condition"}, {"kind and size", "in full"}},
              {}};
    const auto add = [&](const std::vector<task::PerturbationSpec>& list, const std::string& in) {
        for (const task::PerturbationSpec& p : list)
            out.rows.push_back({p.name, in, kind_and_size(p)});
    };
    add(task.perturbations, "");
    for (const auto* list : {&task.rounds, &task.conditions}) {
        for (const task::Condition& condition : *list) add(condition.perturbations, condition.name);
    }
    return out;
}

std::string unmeasured_in(const std::string& named, const Unmeasured& unmeasured) {
    std::string out;
    for (const auto& [name, what] : unmeasured) {
        if (task::names_perturbation(named, name)) out += (out.empty() ? "" : ", ") + what;
    }
    return out;
}

rows::TrialKind kind_of(const rows::AskedRow& asked, const Unmeasured& unmeasured) {
    if (asked.kind != rows::TrialKind::visual_clamp) return asked.kind;
    const std::string what = unmeasured_in(asked.perturbation, unmeasured);
    return what.find(kForceChannel) == std::string::npos ? asked.kind
                                                         : rows::TrialKind::force_channel;
}

}  // namespace dihaptic::analysis
