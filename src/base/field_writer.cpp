#include "base/field_writer.h"

#include <fmt/format.h>

#include <cmath>

namespace dihaptic {
namespace {

/// The shortest text that reads back as the same number.
Node exact(double value) {
    return Node::of(fmt::format("{}", value));
}

}  // namespace

void FieldWriter::operator()(std::string_view name, const double& value, Field field) {
    if (std::isinf(value)) return;
    mapping_.set(si_key(name, field.quantity), exact(value));
}

void FieldWriter::operator()(std::string_view name, const std::optional<double>& value,
                             Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const Vec3& value, Field field) {
    Node list;
    list.kind = Node::Kind::sequence;
    for (int i = 0; i < 3; ++i) list.items.push_back(exact(value[i]));
    mapping_.set(si_key(name, field.quantity), list);
}

void FieldWriter::operator()(std::string_view name, const std::optional<Vec3>& value, Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const int& value, Field) {
    mapping_.set(std::string(name), Node::of(std::to_string(value)));
}

void FieldWriter::operator()(std::string_view name, const bool& value, Field) {
    mapping_.set(std::string(name), Node::of(value ? "yes" : "no"));
}

void FieldWriter::operator()(std::string_view name, const std::string& value, Field) {
    if (!value.empty()) mapping_.set(std::string(name), Node::of(value));
}

void FieldWriter::operator()(std::string_view name, const std::vector<std::string>& value, Field) {
    Node list;
    list.kind = Node::Kind::sequence;
    for (const std::string& item : value) list.items.push_back(Node::of(item));
    if (!list.items.empty()) mapping_.set(std::string(name), list);
}

void FieldWriter::operator()(std::string_view name, const std::vector<double>& value, Field field) {
    Node list;
    list.kind = Node::Kind::sequence;
    for (const double item : value) list.items.push_back(exact(item));
    if (!list.items.empty()) mapping_.set(si_key(name, field.quantity), list);
}

void FieldWriter::operator()(std::string_view name, const Node& value, Field) {
    if (value.kind != Node::Kind::null) mapping_.set(std::string(name), value);
}

}  // namespace dihaptic
