#include "analysis/perturbations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/field_reader.h"
#include "base/regular_file.h"
#include "base/unit.h"
#include "task/trials.h"

namespace dihaptic::analysis {
namespace {

/// The number in this unit, or the text that gives it.
std::string in_words(const Formula& number, double unit = 1) {
    return number.computed() ? number.text : fmt::format("{:.6g}", number.value / unit);
}

std::string in_words(const FormulaVec3& v) {
    return fmt::format("({}, {}, {})", in_words(v[0]), in_words(v[1]), in_words(v[2]));
}

std::string in_words(const Vec3& v) {
    return in_words(FormulaVec3{v.x(), v.y(), v.z()});
}

/// Adds "NAME factor" unless the factor changes nothing.
void add_factor(std::vector<std::string>& out, const char* name, const Formula& factor) {
    if (factor != 1) out.push_back(fmt::format("{} {} times", name, in_words(factor)));
}

const FormulaVec3 kOnes{1, 1, 1};

void say_kinds(const task::VisualSpec& visual, std::vector<std::string>& out) {
    if (!visual.toward.empty()) out.push_back("visual clamp toward " + visual.toward);
    if (visual.angle != 0)
        out.push_back(fmt::format("rotation by {} deg about {}", in_words(visual.angle, kDegree),
                                  in_words(visual.axis.value_or(Vec3::Zero()))));
    if (visual.scale != kOnes) out.push_back("visual gain " + in_words(visual.scale));
    add_factor(out, "displayed size", visual.size);
    if (visual.delay != 0)
        out.push_back(fmt::format("shown {} ms late", in_words(visual.delay, 1e-3)));
    if (!visual.noise.isZero(0))
        out.push_back("shaken by " + in_words(Vec3(visual.noise * 1e3)) + " mm (SD)");
}

void say_kinds(const task::BodySpec& body, std::vector<std::string>& out) {
    if (body.mass_scale != kOnes) out.push_back("inertia " + in_words(body.mass_scale) + " times");
    add_factor(out, "weight", body.weight_scale);
    add_factor(out, "density", body.density_scale);
    add_factor(out, "friction", body.friction_scale);
    add_factor(out, "stiffness", body.stiffness_scale);
    add_factor(out, "restitution", body.restitution_scale);
}

void say_kinds(const task::JointSpec& joint, std::vector<std::string>& out) {
    const auto add = [&](const char* what, const Formula& factor) {
        add_factor(out, (std::string(what) + " of " + joint.joint).c_str(), factor);
    };
    add("stiffness", joint.stiffness_scale);
    add("damping", joint.damping_scale);
    add("friction", joint.friction_scale);
}

std::string kind_and_size(const task::LoadSpec& load) {
    switch (load.kind) {
        case task::LoadKind::constant:
            return fmt::format("constant force {} N", in_words(load.force)) +
                   (load.torque == FormulaVec3{} ? ""
                                                 : fmt::format(", {} N*m", in_words(load.torque)));
        case task::LoadKind::viscous:
        case task::LoadKind::curl:
            return fmt::format("{} field of {} N*s/m", enum_name(load.kind),
                               in_words(load.damping));
        case task::LoadKind::general:
            return "general field";
        case task::LoadKind::spring:
            return fmt::format("spring of {} N/m", in_words(load.stiffness));
        case task::LoadKind::channel:
            return fmt::format("force channel{} of {} N/m",
                               load.normal || load.free ? " (a plane)" : "",
                               in_words(load.stiffness));
    }
    return "";
}

/// What the perturbation is, and how large.
std::string kind_and_size(const task::PerturbationSpec& perturbation) {
    std::vector<std::string> out;
    if (perturbation.visual) say_kinds(*perturbation.visual, out);
    if (perturbation.body) say_kinds(*perturbation.body, out);
    if (perturbation.joint) say_kinds(*perturbation.joint, out);
    for (const task::LoadSpec& load : perturbation.all_loads()) out.push_back(kind_and_size(load));
    return fmt::format("{}", fmt::join(out, "; "));
}

/// Description of the perturbation if its learning is not measured; otherwise "".
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
        Diagnostics ignored(UnknownKeys::are_left_out);  // what can be read of it tells enough
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
    // with these they are replaced
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
