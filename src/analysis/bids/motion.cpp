#include "analysis/bids/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/bids/tsv.h"
#include "recording/log_scene.h"

namespace dihaptic::analysis::bids {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kObjects = "objects";

Channel latency(const std::string& name) {
    return {name + "_latency",
            "n/a",
            "LATENCY",
            "n/a",
            "s",
            "time of the row, from the first tick of the recording",
            [](const frame::Frame& frame) { return seconds(frame.time); }};
}

/// Channels of a finger, in world coordinates.
std::vector<Channel> channels_of(const std::string& finger, size_t f) {
    std::vector<Channel> out;
    const auto vector = [&](const std::string& what, const std::string& type,
                            const std::string& unit, Vec3 frame::FingerFrame::*field,
                            const std::string& words) {
        for (int i = 0; i < 3; ++i) {
            const std::string axis(1, "xyz"[i]);
            out.push_back({fmt::format("{}_{}_{}", finger, what, axis),
                           type == "MISC" ? "n/a" : axis, type,
                           what.starts_with("proxy") ? finger + "_proxy" : finger, unit,
                           words + ", " + axis, [field, i, f](const frame::Frame& frame) {
                               return (frame.fingers[f].*field)[i];
                           }});
        }
    };
    using frame::FingerFrame;
    vector("position", "POS", "m", &FingerFrame::p_WH, "of the device's handle");
    vector("velocity", "VEL", "m/s", &FingerFrame::v_WH, "of the device's handle");
    vector("proxy_position", "POS", "m", &FingerFrame::p_WP, "of the finger in the virtual world");
    vector("force_sent", "MISC", "N", &FingerFrame::f_sent_W, "force on the handle");
    vector("contact_force", "MISC", "N", &FingerFrame::f_contact_W,
           "force of the touched bodies on the finger in the virtual world");
    out.push_back(latency(finger));
    return out;
}

/// Adds the channels of a body's pose, in world coordinates.
void add_body(std::vector<Channel>& out, const std::string& body, size_t b) {
    for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        out.push_back({body + "_position_" + axis, axis, "POS", body, "m",
                       "of the body's origin, " + axis,
                       [b, i](const frame::Frame& frame) { return frame.bodies[b].X_WB.p[i]; }});
    }
    for (int i = 0; i < 4; ++i) {
        const std::string part(1, "xyzw"[i]);  // same order as in Eigen
        out.push_back(
            {body + "_orientation_" + part, "quat_" + part, "ORNT", body, "n/a",
             "unit quaternion that turns the body's axes into the world's, " + part,
             [b, i](const frame::Frame& frame) { return frame.bodies[b].X_WB.R.coeffs()[i]; }});
    }
}

/// Indices of the log's bodies that can move.
std::vector<size_t> moving_bodies(const recording::SessionFolder& session,
                                  const recording::LogHead& head) {
    std::vector<size_t> out;
    std::optional<scene::Scene> scene;
    try {
        Diagnostics diagnostics(UnknownKeys::are_left_out);
        scene = scene::read_scene(session.file("scene.yaml"), diagnostics);
        if (diagnostics.has_errors() || !recording::fits(head, *scene)) scene.reset();
    } catch (const Error&) {
        scene.reset();
    }
    for (size_t b = 0; b < head.bodies.size(); ++b) {
        if (!scene || scene->bodies[b].moves_at_all()) out.push_back(b);
    }
    return out;
}

}  // namespace

std::string label(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) out += c;
    }
    return out.empty() ? "unnamed" : out;
}

std::vector<TrackingSystem> tracking_systems(const recording::SessionFolder& session,
                                             const recording::SessionInfo& info,
                                             const recording::LogHead& head) {
    std::vector<TrackingSystem> out;
    std::set<std::string> labels{kObjects};
    for (size_t f = 0; f < head.fingers.size(); ++f) {
        const std::string& finger = head.fingers[f];
        if (!labels.insert(label(finger)).second) {
            throw Error(
                {session.path(), 0}, finger,
                "has the label of another finger, or of the objects: " + label(finger),
                "BIDS labels have letters and digits only: give it another name in the scene.");
        }
        std::string model = "unknown";
        for (const recording::DeviceRecord& device : info.devices) {
            if (device.finger == finger) model = device.model;
        }
        out.push_back({finger, model, channels_of(finger, f), 2});
    }
    TrackingSystem objects{kObjects, "simulated physics", {}, 0};
    for (const size_t b : moving_bodies(session, head)) {
        add_body(objects.channels, head.bodies[b], b);
        ++objects.points;
    }
    if (objects.points == 0) return out;
    objects.channels.push_back(latency(kObjects));
    out.push_back(std::move(objects));
    return out;
}

std::string channels_tsv(const TrackingSystem& system, double tick) {
    std::vector<Row> rows{{"name", "component", "type", "tracked_point", "units",
                           "sampling_frequency", "reference_frame", "description"}};
    for (const Channel& c : system.channels)
        rows.push_back({c.name, c.component, c.type, c.point, c.unit, fmt::format("{:g}", 1 / tick),
                        "global", c.what});
    return to_tsv(rows);
}

std::string channels_json() {
    // RotationOrder is omitted, since orientations are quaternions
    const Json levels{
        {"reference_frame",
         {{"Levels",
           {{"global",
             {{"SpatialAxes", "RAS"},
              {"RotationRule", "right-hand"},
              {"Description",
               "x to the right, y away from the person, z up; origin on the table top"}}}}}}}};
    return levels.dump(2) + "\n";
}

std::string motion_json(const TrackingSystem& system, const std::string& task,
                        const recording::SessionInfo& info, double tick, int64_t ticks) {
    std::map<std::string, int> counts;
    for (const Channel& c : system.channels) ++counts[c.type];
    Json json{{"TaskName", task},
              // the description also states who moved the hand, for which the schema has no key
              {"TaskDescription", info.title + ". " + info.moved_by.describe()},
              {"SamplingFrequency", 1 / tick},
              {"TrackingSystemName", label(system.name)},
              {"ManufacturersModelName", system.model},
              {"SoftwareVersions", info.program},
              {"MotionChannelCount", system.channels.size()},
              {"TrackedPointsCount", system.points},
              {"RecordingType", "continuous"},
              {"RecordingDuration", static_cast<double>(ticks) * tick}};
    if (!info.study.institution.empty()) json["InstitutionName"] = info.study.institution;
    for (const auto& [type, count] : counts) json[type + "ChannelCount"] = count;
    return json.dump(2) + "\n";
}

}  // namespace dihaptic::analysis::bids
