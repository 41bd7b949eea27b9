#include "session/file_schemas.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/choices.h"
#include "base/installed.h"
#include "base/json_schema.h"
#include "frame/settings.h"
#include "person/population.h"
#include "rig/kinds.h"
#include "scene/kinds.h"
#include "study/study_file.h"
#include "task/file/experiment.h"
#include "task/file/kinds.h"

namespace dihaptic::session {
namespace {

/// The schema of mappings whose keys are names chosen in the file itself.
Json by_name(const Json& value) {
    return {{"type", {"object", "null"}}, {"additionalProperties", value}};
}

template <class Struct>
std::string schema_of(const char* heading) {
    JsonSchema schema;
    schema.part("settings", "Settings", frame::Settings{});
    schema.part("hand", "Hand", hand::HandSpec{});
    schema.part("bodies", by_name(JsonSchema::yes_or_no()));
    schema.part("fingers", by_name(JsonSchema::yes_or_no()));
    schema.part("factors", by_name(JsonSchema::word()));
    for (const devices::Backend& backend : devices::backends()) {
        if (backend.options != nullptr) backend.options(schema);
    }
    for (const outlets::Kind& kind : outlets::kinds()) kind.options(schema);
    return schema.of(Struct{}, heading).dump(1) + "\n";
}

constexpr std::array kSchemas{
    FileSchema{"scene", [] { return schema_of<scene::Scene>("Scene"); }},
    FileSchema{"rig", [] { return schema_of<rig::Rig>("Rig"); }},
    FileSchema{"experiment", [] { return schema_of<task::Experiment>("Experiment"); }},
    FileSchema{"study", [] { return schema_of<study::StudyFile>("Study"); }},
    FileSchema{"form", [] { return schema_of<task::Form>("Form"); }},
    FileSchema{"population", [] { return schema_of<person::Population>("Population"); }},
    FileSchema{"calibration", [] { return schema_of<rig::Calibration>("Calibration"); }},
    FileSchema{"registration", [] { return schema_of<display::Registration>("Registration"); }},
};

}  // namespace

std::span<const FileSchema> file_schemas() {
    return kSchemas;
}

const FileSchema& file_schema(const std::string& name) {
    const auto* const found = std::find_if(kSchemas.begin(), kSchemas.end(),
                                           [&](const FileSchema& s) { return s.name == name; });
    if (found != kSchemas.end()) return *found;
    std::vector<std::string> names;
    for (const FileSchema& schema : kSchemas) names.emplace_back(schema.name);
    throw Error(fmt::format("'{}' is not a kind of file that has a schema", name),
                fmt::format("Known: {}.", listed(names)));
}

namespace {

/// Converts a path to the form that editors can read: in a plain path, a space would end the path.
std::string as_address(const std::string& path) {
    constexpr std::string_view kPlain = "/._~-";
    const auto is_plain = [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               kPlain.find(c) != std::string_view::npos;
    };
    if (std::ranges::all_of(path, is_plain)) return path;
    std::string out = "file://";
    for (const char c : path) {
        if (is_plain(c)) {
            out += c;
        } else {
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return out;
}

}  // namespace

std::string schema_line(const std::string& name) {
    const std::string file = fmt::format("schema/{}.json", name);
    const std::string found = in_or_above_program({file, "share/dihaptic/" + file});
    return found.empty() ? ""
                         : fmt::format("# yaml-language-server: $schema={}\n", as_address(found));
}

}  // namespace dihaptic::session
