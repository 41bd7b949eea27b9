#include "scene/name_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/choices.h"
#include "base/text.h"
#include "scene/names.h"

namespace dihaptic::scene {
namespace {

/// Checks that no two columns have the same name: a body called "thumb_proxy" and the thumb's proxy
/// would both have a column thumb_proxy_position.
void check_columns(const Scene& scene, Diagnostics& diagnostics) {
    std::set<std::string> taken;
    for (const Finger& finger : scene.fingers) {
        taken.insert(finger.name + "_contact");
        for (const char* part : {"_device", "_handle", "_proxy"}) {
            taken.insert(finger.name + part);
            taken.insert(finger.name + part + "_angular");
        }
    }
    const auto for_each_thing = [&](const auto& act) {
        for (const Body& body : scene.bodies) act(body.name, body.place);
        for (const Joint& joint : scene.joints) act(joint.name, joint.place);
    };
    for_each_thing([&](const std::string& name, const Place&) { taken.insert(name + "_angular"); });
    for_each_thing([&](const std::string& name, const Place& place) {
        if (taken.contains(name))
            diagnostics.error(
                place, "name",
                fmt::format("'{}' is the name of another object's part in recordings", name),
                "Choose another name.");
    });
}

/// Whether a text may be a name. Names become parts of paths in the session's folder and in its NWB
/// file.
bool may_be_name(const std::string& name) {
    return !name.starts_with('.') && name.find_first_of("/\\") == std::string::npos &&
           !find_fault(name, Lines::one);
}

}  // namespace

void check_names(const Scene& scene, Diagnostics& diagnostics) {
    // the default fingers, thumb and index, have no line in the file
    const bool in_file = !scene.fingers.empty() && !scene.fingers.front().place.file.empty();
    std::set<std::string> names;
    for (const Finger& finger : scene.fingers) {
        if (!in_file) names.insert(finger.name);
    }
    const auto check = [&](const std::string& name, const Place& place) {
        if (!may_be_name(name)) {
            diagnostics.error(place, "name", fmt::format("'{}' cannot be a name", name),
                              "Use letters, digits, blanks, '-' and '_'.");
        }
        if (name.size() > kLongestName) {
            diagnostics.error(place, "name", fmt::format("has {} bytes", name.size()),
                              fmt::format("Choose a name of at most {} bytes.", kLongestName));
        }
        if (!name.empty() && !names.insert(name).second) {
            diagnostics.error(place, "name", fmt::format("'{}' is used twice", name),
                              in_file ? "Give each body, finger and joint a name of its own."
                                      : "Give each body, finger and joint a name of its own; where "
                                        "fingers are left out, they are called thumb and index.");
        }
    };
    for (const Body& body : scene.bodies) check(body.name, body.place);
    for (const Finger& finger : scene.fingers) {
        if (in_file) check(finger.name, finger.place);
    }
    for (const Joint& joint : scene.joints) check(joint.name, joint.place);
    check_columns(scene, diagnostics);
}

void check_references(const Scene& scene, Diagnostics& diagnostics) {
    std::vector<std::string> known = finger_names(scene);
    std::vector<std::string> movable;
    for (const Body& body : scene.bodies) {
        known.push_back(body.name);
        if (body.moves_at_all()) movable.push_back(body.name);
    }
    const auto must_exist = [&](const std::string& name, const char* key, const Place& place,
                                const std::vector<std::string>& choices) {
        if (std::find(known.begin(), known.end(), name) != known.end()) return;
        diagnostics.error(place, key, fmt::format("there is no body or finger '{}'", name),
                          meant(name, known, diagnostics, "There are"), choices_of(choices));
    };
    std::set<std::pair<std::string, std::string>> pairs;
    for (const Pair& pair : scene.pairs) {
        for (const std::string& name : pair.between) must_exist(name, "between", pair.place, known);
        if (pair.between.size() != 2) {
            diagnostics.error(pair.place, "between", "must be two names",
                              "Write between: [block, thumb].");
            continue;
        }
        const auto& [a, b] = std::minmax(pair.between[0], pair.between[1]);
        if (a == b) {
            diagnostics.error(pair.place, "between", fmt::format("'{}' cannot touch itself", a),
                              "Name two different bodies or fingers.");
        } else if (!pairs.insert({a, b}).second) {
            diagnostics.error(pair.place, "between",
                              fmt::format("the pair of {} and {} is given twice", a, b),
                              "Keep one of the two.");
        }
    }
    if (scene.object.empty()) return;
    if (const int object = scene.find(scene.object); object < 0) {
        must_exist(scene.object, "object", scene.object_place, movable);
        if (std::find(known.begin(), known.end(), scene.object) != known.end()) {
            diagnostics.error(scene.object_place, "object",
                              fmt::format("'{}' is a finger", scene.object), "Name a body.");
        }
    } else if (!scene.bodies[static_cast<size_t>(object)].moves_at_all()) {
        diagnostics.error(scene.object_place, "object", fmt::format("'{}' is fixed", scene.object),
                          "Name a movable body; summaries describe this body.");
    }
}

}  // namespace dihaptic::scene
