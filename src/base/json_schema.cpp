#include "base/json_schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/number.h"

namespace dihaptic {
namespace {

/// The syntax of the numbers that finite_number() accepts; FieldReader also accepts quotes around a
/// number.
constexpr const char* kNumber = R"(^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$)";
constexpr double kLargestWhole = 1e9;  // of FieldReader

/// A number as people would write it, without the rounding errors of a conversion.
Json plain(double value) {
    const double round = finite_number(number_text(value, 9)).value_or(value);
    if (std::abs(round - value) <= 1e-12 * std::abs(value)) value = round;
    if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<int64_t>(value);
    return value;
}

void add_bounds(Json& schema, const Field& field, double si) {
    if (std::isfinite(field.min))
        schema[field.above_min ? "exclusiveMinimum" : "minimum"] = plain(field.min / si);
    if (std::isfinite(field.max)) schema["maximum"] = plain(field.max / si);
}

Json three(const Json& item) {
    return {{"type", "array"}, {"items", item}, {"minItems", 3}, {"maxItems", 3}};
}

/// A value of one of these types, or true or false. The latter two are not given as the type
/// boolean, because editors propose true and false wherever a type may be boolean.
Json one_of_these(const std::vector<std::string>& types, const char* said) {
    Json others{"string", "number", "object", "array", "null"};
    return {{"anyOf", {{{"type", types}, {"errorMessage", said}}, {{"not", {{"type", others}}}}}}};
}

Json text(const Field& field) {
    Json out = JsonSchema::word();
    if (field.is_required) out["minLength"] = 1;
    return out;
}

/// The default of a field, in the form written by FieldWriter and in the key's unit; null if there
/// is none.
Json preset_of(const Node& node, double si) {
    if (node.kind == Node::Kind::scalar) {
        const auto number = node.plain ? finite_number(node.scalar) : std::nullopt;
        return number ? plain(*number / si) : Json(node.scalar);
    }
    if (node.kind != Node::Kind::sequence || node.items.empty()) return nullptr;
    Json out = Json::array();
    for (const Node& item : node.items) out.push_back(preset_of(item, si));
    return out;
}

/// The value as a person would write it in a file.
std::string in_words(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_array()) return value.dump();
    std::vector<std::string> items;
    for (const Json& item : value) items.push_back(in_words(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
}

Json condition(std::string_view key, const Json& value) {
    return {{"properties", {{key, value}}}, {"required", {key}}};
}

bool has_key(const SchemaKeys& of, const SchemaKeys::Key& key) {
    return std::any_of(of.keys.begin(), of.keys.end(), [&](const SchemaKeys::Key& other) {
        return other.name == key.name && other.schema == key.schema;
    });
}

bool requires_one_of(const SchemaKeys& keys, const std::vector<std::string>& names) {
    return std::find(keys.required.begin(), keys.required.end(), names) != keys.required.end();
}

void require(Json& schema, const std::vector<std::vector<std::string>>& required) {
    for (const std::vector<std::string>& names : required) {
        if (names.size() == 1) {
            schema["required"].push_back(names.front());
            continue;
        }
        const std::string said = fmt::format(
            "needs {} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
        Json any = Json::array();
        for (const std::string& name : names)
            any.push_back({{"required", {name}}, {"errorMessage", said}});
        schema["allOf"].push_back({{"anyOf", any}});
    }
}

/// The keys of one kind of struct. Keys in `common` are also allowed, but are not described again.
Json keys_of_kind(const SchemaKeys& keys, const SchemaKeys& common) {
    Json out{{"properties", Json::object()}, {"additionalProperties", false}};
    for (const SchemaKeys::Key& key : keys.keys)
        out["properties"][key.name] = has_key(common, key) ? Json(true) : key.schema;
    std::vector<std::vector<std::string>> own;
    for (const auto& names : keys.required) {
        if (!requires_one_of(common, names)) own.push_back(names);
    }
    require(out, own);
    return out;
}

/// The keys that all the kinds have in common.
SchemaKeys common_keys(const std::vector<SchemaKeys>& each) {
    SchemaKeys out;
    const auto everywhere = [&](const auto& has) {
        return std::all_of(each.begin(), each.end(), has);
    };
    for (const SchemaKeys::Key& key : each.front().keys) {
        if (everywhere([&](const SchemaKeys& kind) { return has_key(kind, key); }))
            out.keys.push_back(key);
    }
    for (const auto& names : each.front().required) {
        if (everywhere([&](const SchemaKeys& kind) { return requires_one_of(kind, names); }))
            out.required.push_back(names);
    }
    return out;
}

}  // namespace

Json JsonSchema::word() {
    return one_of_these({"string", "number"}, "must be a single word or text");
}

Json JsonSchema::reference(const std::string& definition) {
    return {{"$ref", "#/definitions/" + definition}};
}

Json JsonSchema::whole(const Json& keys, const std::string& heading) const {
    Json out{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", heading}};
    out.update(keys);
    out["definitions"] = definitions_;
    return out;
}

Json JsonSchema::mapping(const SchemaKeys& keys) {
    Json out{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
    for (const auto& [name, schema] : keys.keys) out["properties"][name] = schema;
    require(out, keys.required);
    return out;
}

Json JsonSchema::mapping(std::string_view key, const std::vector<std::string_view>& words,
                         const std::vector<SchemaKeys>& each) {
    const SchemaKeys common = common_keys(each);
    Json out = mapping(common);
    out.erase("additionalProperties");  // each kind lists the additional keys that it allows
    Json known = Json::array();
    bool any_word = false;
    for (const std::string_view word : words) {
        if (word.empty())
            any_word = true;
        else
            known.push_back(word);
    }
    Json& of_key = out["properties"][std::string(key)];
    assert(!of_key.is_null());
    if (any_word)
        of_key["examples"] = known;
    else
        of_key.update({{"type", "string"}, {"enum", known}});
    for (size_t i = 0; i < words.size(); ++i) {
        const bool is_other = words[i].empty();
        out["allOf"].push_back(
            {{"if", condition(key, is_other ? Json{{"enum", known}} : Json{{"const", words[i]}})},
             {is_other ? "else" : "then", keys_of_kind(each[i], common)}});
    }
    return out;
}

SchemaKeys JsonSchema::either(SchemaKeys one, const SchemaKeys& other) {
    for (auto& [name, schema] : one.keys) {
        const auto same = std::find_if(other.keys.begin(), other.keys.end(),
                                       [&own = name](const auto& key) { return key.name == own; });
        assert(same != other.keys.end());
        if (same->schema == schema) continue;
        Json both{{"description", schema.value("description", "")}};
        schema.erase("description");
        both["anyOf"] = {schema, same->schema};
        schema = both;
    }
    return one;
}

Json JsonSchema::part_of(const std::string& name, std::string_view word) const {
    auto known = parts_.find({name, std::string(word)});
    if (known == parts_.end()) known = parts_.find({name, ""});
    return known == parts_.end() ? Json{{"type", {"object", "null"}}} : known->second();
}

void SchemaLister::add(std::string_view name, const Field& field, const Node& written,
                       const std::function<Json(double si)>& schema) {
    const bool has_default = !written.entries.empty() && !field.is_required;
    const Node preset = has_default ? written.entries.front().value : Node{};
    std::vector<std::string> names;
    Json best;
    const auto add_key = [&](const std::string& key, double si) {
        Json value = schema(si);
        std::string said(field.what);
        const Json given = preset_of(preset, si);
        if (!given.is_null()) {
            said += fmt::format("{}Default: {}.", said.empty() ? "" : " ", in_words(given));
            if (best.is_null() || given.dump().size() < best.dump().size()) best = given;
        }
        if (!said.empty()) value["description"] = said;
        if (!given.is_null()) value["default"] = given;
        found_.keys.push_back({key, value});
        names.push_back(key);
    };
    for (const Unit& unit : units(field.quantity))
        add_key(fmt::format("{}_{}", name, unit.suffix), unit.si);
    if (names.empty()) add_key(std::string(name), 1);
    if (field.is_required) found_.required.push_back(names);
    keep_one_default(names.size(), best);
}

/// Keeps a value's default in one unit only, because an editor that starts a mapping inserts all
/// keys that have a default.
void SchemaLister::keep_one_default(size_t units, const Json& best) {
    bool kept = false;
    for (size_t i = found_.keys.size() - units; i < found_.keys.size(); ++i) {
        Json& schema = found_.keys[i].schema;
        if (kept || schema.value("default", Json()) != best) schema.erase("default");
        kept = kept || schema.contains("default");
    }
}

Json SchemaLister::one_of(std::vector<std::string> words) {
    return {{"type", "string"}, {"enum", std::move(words)}};
}

Json SchemaLister::list_of(Json items) {
    return {{"type", "array"}, {"items", std::move(items)}};
}

Json SchemaLister::of(double, const Field& field, double si, const std::string&) {
    Json out{{"type", {"number", "string"}}};
    add_bounds(out, field, si);
    out["pattern"] = kNumber;
    out["patternErrorMessage"] = "must be a number";
    return out;
}

Json SchemaLister::of(const Vec3&, const Field& field, double si, const std::string& name) {
    return three(of(0.0, field, si, name));
}

Json SchemaLister::of(const Mat3&, const Field& field, double si, const std::string& name) {
    return three(three(of(0.0, field, si, name)));
}

Json SchemaLister::of(const Formula&, const Field& field, double si, const std::string&) {
    Json out{{"type", {"number", "string"}}};
    add_bounds(out, field, si);
    out["minLength"] = 1;
    return out;
}

Json SchemaLister::of(const FormulaVec3&, const Field& field, double si, const std::string& name) {
    return three(of(Formula{}, field, si, name));
}

Json SchemaLister::of(const std::vector<double>&, const Field& field, double si,
                      const std::string& name) {
    return {{"type", "array"}, {"items", of(0.0, field, si, name)}, {"minItems", 1}};
}

Json SchemaLister::of(int, const Field& field, double, const std::string& name) {
    Field whole = field;
    whole.min = std::max(field.min, -kLargestWhole);
    whole.max = std::min(field.max, kLargestWhole);
    Json out = of(0.0, whole, 1, name);
    out["type"] = Json::array({"integer", "string"});
    return out;
}

Json SchemaLister::of(bool, const Field&, double, const std::string&) {
    return JsonSchema::yes_or_no();
}

Json SchemaLister::of(const std::string&, const Field& field, double, const std::string&) {
    return text(field);
}

Json SchemaLister::of(const std::vector<std::string>&, const Field& field, double,
                      const std::string&) {
    return {{"type", "array"}, {"items", text(field)}};
}

Json SchemaLister::of(const Texts&, const Field& field, double, const std::string&) {
    Json out = one_of_these({"string", "number", "array"}, "must be a text or a list of texts");
    if (field.is_required) out["minLength"] = 1;
    out["items"] = text(field);
    return out;
}

}  // namespace dihaptic
