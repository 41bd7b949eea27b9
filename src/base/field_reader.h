// Reads configuration structs (base/field.h) from YAML, and reports all mistakes in it: unknown
// keys, wrong units, wrong types, values out of bounds, and missing fields.
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

/// Visitor that fills one struct from one mapping. A field that is missing from the mapping keeps
/// its value, so if two files are read into the same struct, the later file overrides the earlier
/// one.
class FieldReader {
  public:
    /// `path` is the path of the struct itself in `origins` ("" for the outermost struct);
    /// `origins` may be null.
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
    /// Reads a matrix: three rows of three numbers each.
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

    /// Keeps a part of the file as a Node, without reading it, for a reader that knows its content.
    void operator()(std::string_view name, Node& value, Field field = {});

    /// Declares a field that belongs only to structs of another kind; giving it here is an error.
    void foreign(std::string_view name, const Field& field, const std::string& remedy);

    /// The place where the struct itself was written. place_of() returns the place of a field or,
    /// if the field is missing, that of the struct.
    Place place() const;
    Place place_of(std::string_view name) const;
    /// Whether the mapping gives the field, in any unit.
    bool has(std::string_view name, Quantity quantity = Quantity::none) const;
    /// Whether the mapping has a key that is meant for the field, even if its value cannot be read.
    bool mentions(std::string_view name) const;
    /// Whether the field, which may be a list or a mapping, is given as a list.
    bool is_list(std::string_view name) const;
    Diagnostics& diagnostics() { return diagnostics_; }

    /// Reads a struct from the whole mapping, and reports keys that belong to no field. If the
    /// struct has a member `place`, that member is set to the mapping's place.
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
    /// The keys that are allowed here and have not been given yet.
    std::vector<Choice> choices() const;
    /// Returns `given` or, if the field is given under its old name, the entry with that name.
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

/// Reads a whole mapping into a struct, and adds any problems to `diagnostics`.
template <class Struct>
void read_fields(Struct& value, const Node& mapping, Diagnostics& diagnostics,
                 Origins* origins = nullptr) {
    if (mapping.kind != Node::Kind::mapping) {
        diagnostics.error(mapping.place, "", "is not a list of keys and values",
                          "Write one 'key: value' per line.");
        return;
    }
    FieldReader(mapping, diagnostics, origins).read_whole(value);
}

/// Like read_fields(), for a mapping that may be omitted, in which case all fields keep their
/// defaults.
template <class Struct>
void read_given_fields(Struct& value, const Node& mapping, Diagnostics& diagnostics,
                       Origins* origins = nullptr) {
    if (mapping.kind != Node::Kind::null) read_fields(value, mapping, diagnostics, origins);
}

}  // namespace dihaptic
