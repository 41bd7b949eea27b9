#include "analysis/perturbations.h"

#include <algorithm>
#include <cstdlib>

#include "base/node.h"
#include "base/regular_file.h"

namespace dihaptic::analysis {
namespace {

/// Whether the body has a mass for each axis, and they differ.
bool differs_by_direction(const Node& body) {
    const Node* scale = body.find("mass_scale");
    if (scale == nullptr || scale->items.size() < 2) return false;
    const auto value = [](const Node& node) { return std::strtod(node.scalar.c_str(), nullptr); };
    const double first = value(scale->items.front());
    return std::any_of(scale->items.begin(), scale->items.end(),
                       [&](const Node& node) { return value(node) != first; });
}

/// Description of the perturbation if its learning is not measured; otherwise "".
std::string what_of(const Node& perturbation) {
    if (const Node* field = perturbation.find("field")) {
        const Node* kind = field->find("kind");
        const std::string name = kind == nullptr ? "viscous" : kind->scalar;
        return name == "channel" ? "a force channel" : "a force field (" + name + ")";
    }
    const Node* body = perturbation.find("body");
    return body != nullptr && differs_by_direction(*body) ? "a mass that differs by direction" : "";
}

/// Collects the perturbations of the task, and those with which its rounds and conditions replace
/// them.
void collect(const Node& node, Unmeasured& out) {
    if (const Node* list = node.find("perturbations")) {
        for (const Node& perturbation : list->items) {
            const Node* name = perturbation.find("name");
            const std::string what = what_of(perturbation);
            if (name != nullptr && !what.empty()) out[name->scalar] = what;
        }
    }
    for (const char* key : {"rounds", "conditions"}) {
        const Node* list = node.find(key);
        if (list == nullptr) continue;
        for (const Node& item : list->items) collect(item, out);
    }
}

}  // namespace

Unmeasured unmeasured_perturbations(const std::string& task_file) {
    Unmeasured out;
    if (!is_there(task_file)) return out;
    try {
        collect(read_yaml(task_file), out);
    } catch (const Error&) {
        return {};
    }
    return out;
}

}  // namespace dihaptic::analysis
