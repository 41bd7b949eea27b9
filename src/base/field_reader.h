// Reads configuration structs (base/field.h) from YAML, and reports all mistakes in the
// YAML: unknown keys, wrong units, wrong types, values out of bounds, missing fields.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/field.h"
#include "base/formula.h"
#include "base/geometry.h"
#include "base/node.h"
#include "base/number.h"

namespace dihaptic {

/// Where each setting came from: maps its path ("coupling.stiffness") to "file:line" or "command
/// line".
using Origins = std::map<std::string, std::string>;

/// Visitor that fills one struct from one mapping. A field that the mapping lacks keeps its value,
/// so a later file overrides an earlier one when both are read into the same struct in turn.
class FieldReader {
  public:
    /// `path` is the struct's own path in `origins` ("" for the outermost); `origins` may be null.
    FieldReader(const Node& mapping, Diagnostics& diagnostics, Origins* origins = nullptr,
                std::string path = "");

    void operator()(std::string_view name, double& value, Field field = {});
    void operator()(std::string_view name, std::optional<double>& value, Field field = {});
    void operator()(std::string_view name, Vec3& value, Field field = {});
    void operator()(std::string_view name, std::optional<Vec3>& value, Field field = {});
    void operator()(std::string_view name, Formula& value, Field field = {});
    void operator()(std::string_view name, std::optional<Formula>& value, Field field = {});
    void operator()(std::string_view name, FormulaVec3& value, Field field = {});
    void operator()(std::string_view name, std::optional<FormulaVec3>& value, Field field = {});
    /// Three rows of three numbers.
    void operator()(std::string_view name, Mat3& value, Field field = {});
    void operator()(std::string_view name, int& value, Field field = {});
    void operator()(std::string_view name, bool& value, Field field = {});
    void operator()(std::string_view name, std::string& value, Field field = {});
    void operator()(std::string_view name, std::vector<std::string>& value, Field field = {});
    void operator()(std::string_view name, Texts& value, Field field = {});
    void operator()(std::string_view name, std::vector<double>& value, Field field = {});

    template <NamedEnum E>
    void operator()(std::string_view name, E& value, Field field = {}) {
        const auto names = enum_names(value);
        OldName old;
        if constexpr (requires { old_name(value); }) old = old_name(value);
        const int index = read_choice(name, {names.begin(), names.end()}, field, old);
        if (index >= 0) value = static_cast<E>(index);
    }

    template <NamedEnum E>
    void operator()(std::string_view name, std::optional<E>& value, Field field = {}) {
        E given{};
        const auto names = enum_names(given);
        const int index = read_choice(name, {names.begin(), names.end()}, field);
        if (index >= 0) value = static_cast<E>(index);
    }

    template <class Struct>
    requires Described<Struct, FieldReader>
    void operator()(std::string_view name, Struct& value, Field field = {}) {
        if (const Node* node = take_mapping(name, field))
            read_into(value, *node, std::string(name));
    }

    template <class Struct>
    requires Described<Struct, FieldReader>
    void operator()(std::string_view name, std::optional<Struct>& value, Field field = {}) {
        if (const Node* node = take_mapping(name, field))
            read_into(value.emplace(), *node, std::string(name));
    }

    template <class Struct>
    requires Described<Struct, FieldReader>
    void operator()(std::string_view name, std::vector<Struct>& values, Field field = {}) {
        const Node* list = take_list(name, field);
        if (list == nullptr) return;
        values.clear();
        for (const Node& item : list->items) {
            const std::string place = std::string(name) + "[" + number_text(values.size()) + "]";
            if (is_mapping(item, place)) read_into(values.emplace_back(), item, place);
        }
    }

    /// Keeps a part of the file unread, for a reader that knows its content.
    void operator()(std::string_view name, Node& value, Field field = {});

    /// A field that belongs to structs of another kind; it is an error to give it here.
    void foreign(std::string_view name, const Field& field, const std::string& remedy);

    /// The place at which the struct itself was written; place_of() gives a field's place or,
    /// failing that, the struct's.
    Place place() const;
    Place place_of(std::string_view name) const;
    /// Whether the mapping gives the field, in any unit.
    bool has(std::string_view name, Quantity quantity = Quantity::none) const;
    /// Whether a key is meant for the field, readable or not.
    bool mentions(std::string_view name) const;
    /// Whether the mapping gives the field as a list, where a mapping is possible too.
    bool is_list(std::string_view name) const;
    Diagnostics& diagnostics() { return diagnostics_; }

    /// Reads a struct from the whole mapping. A member `place` becomes the place of the mapping;
    /// keys that belong to no field are reported.
    template <class Struct>
    void read_whole(Struct& value) {
        if constexpr (requires { value.place = place(); }) value.place = place();
        value.visit(*this);
        finish();
    }

  private:
    void finish();

    struct Known {
        std::string name;
        Quantity quantity;
        std::string_view what;
    };
    struct Given {
        const Node* node = nullptr;
        std::string key;
        double to_si = 1;
    };

    Given take(std::string_view name, const Field& field);
    /// Keys that may still be given.
    std::vector<Choice> choices() const;
    /// `given`, or the entry under the field's old name.
    Given take_old(std::string_view name, const Field& field, Given given);
    const Node* take_mapping(std::string_view name, const Field& field);
    const Node* take_list(std::string_view name, const Field& field);
    bool is_mapping(const Node& node, const std::string& key);
    int read_choice(std::string_view name, const std::vector<std::string_view>& names,
                    const Field& field, const OldName& old = {});
    std::optional<double> number(const Given& given, const Node& scalar, const Field& field);
    std::optional<Formula> formula(const Given& given, const Node& scalar, const Field& field);
    bool is_triple(const Given& given);
    std::optional<Vec3> vector(const Given& given, const Field& field);
    std::optional<FormulaVec3> formulas(const Given& given, const Field& field);
    std::optional<std::string> word(const Given& given, const Field& field);
    void note_origin(std::string_view name, const Node& node);

    template <class Struct>
    void read_into(Struct& value, const Node& node, const std::string& name) {
        FieldReader inner(node, diagnostics_, origins_, path_.empty() ? name : path_ + "." + name);
        inner.read_whole(value);
    }

    const Node& mapping_;
    Diagnostics& diagnostics_;
    Origins* origins_;
    std::string path_;
    std::vector<Known> fields_;
    std::set<std::string> used_;
};

/// Reads a whole mapping into a struct; problems go to `diagnostics`.
template <class Struct>
void read_fields(Struct& value, const Node& mapping, Diagnostics& diagnostics,
                 Origins* origins = nullptr) {
    if (mapping.kind != Node::Kind::mapping) {
        diagnostics.error(mapping.place, "", "is not a list of keys and values",
                          "Write one 'key: value' a line.");
        return;
    }
    FieldReader(mapping, diagnostics, origins).read_whole(value);
}

/// Like read_fields(), for a mapping that may be left out; then all fields keep their defaults.
template <class Struct>
void read_given_fields(Struct& value, const Node& mapping, Diagnostics& diagnostics,
                       Origins* origins = nullptr) {
    if (mapping.kind != Node::Kind::null) read_fields(value, mapping, diagnostics, origins);
}

}  // namespace dihaptic
