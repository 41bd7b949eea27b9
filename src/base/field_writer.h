// Writes configuration structs (base/field.h) as YAML, with every value resolved and in SI units;
// sessions store their inputs in this form. A formula is written as it was given, with its unit.
// Reading the result gives a bitwise identical struct. An infinite value cannot be written and is
// left out, so it must be its field's default.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/field.h"
#include "base/formula.h"
#include "base/geometry.h"
#include "base/node.h"

namespace dihaptic {

class FieldWriter {
  public:
    void operator()(std::string_view name, const double& value, Field field = {});
    void operator()(std::string_view name, const std::optional<double>& value, Field field = {});
    void operator()(std::string_view name, const Vec3& value, Field field = {});
    void operator()(std::string_view name, const std::optional<Vec3>& value, Field field = {});
    void operator()(std::string_view name, const Formula& value, Field field = {});
    void operator()(std::string_view name, const std::optional<Formula>& value, Field field = {});
    void operator()(std::string_view name, const FormulaVec3& value, Field field = {});
    void operator()(std::string_view name, const std::optional<FormulaVec3>& value,
                    Field field = {});
    void operator()(std::string_view name, const Mat3& value, Field field = {});
    void operator()(std::string_view name, const int& value, Field field = {});
    void operator()(std::string_view name, const bool& value, Field field = {});
    void operator()(std::string_view name, const std::string& value, Field field = {});
    void operator()(std::string_view name, const std::vector<std::string>& value, Field field = {});
    void operator()(std::string_view name, const Texts& value, Field field = {});
    void operator()(std::string_view name, const std::vector<double>& value, Field field = {});

    template <NamedEnum E>
    void operator()(std::string_view name, const E& value, Field = {}) {
        mapping_.set(std::string(name), Node::of(std::string(enum_name(value))));
    }

    template <NamedEnum E>
    void operator()(std::string_view name, const std::optional<E>& value, Field field = {}) {
        if (value) (*this)(name, *value, field);
    }

    template <class Struct>
    requires Described<Struct, FieldWriter>
    void operator()(std::string_view name, Struct& value, Field = {}) {
        mapping_.set(std::string(name), write(value));
    }

    template <class Struct>
    requires Described<Struct, FieldWriter>
    void operator()(std::string_view name, std::optional<Struct>& value, Field = {}) {
        if (value) mapping_.set(std::string(name), write(*value));
    }

    template <class Struct>
    requires Described<Struct, FieldWriter>
    void operator()(std::string_view name, std::vector<Struct>& values, Field = {}) {
        Node list;
        list.kind = Node::Kind::sequence;
        for (Struct& value : values) list.items.push_back(write(value));
        if (!list.items.empty()) mapping_.set(std::string(name), list);
    }

    void operator()(std::string_view name, const Node& value, Field field = {});

    Node take() { return std::move(mapping_); }

    template <class Struct>
    static Node write(Struct& value) {
        FieldWriter writer;
        value.visit(writer);
        return writer.take();
    }

  private:
    Node mapping_ = Node::mapping();
};

/// Returns the struct as a mapping.
template <class Struct>
Node write_fields(Struct value) {
    return FieldWriter::write(value);
}

}  // namespace dihaptic
