#include "base/field_writer.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"

namespace dihaptic {
namespace {

Node exact(const Vec3& value) {
    Node list;
    list.kind = Node::Kind::sequence;
    for (int i = 0; i < 3; ++i) list.items.push_back(Node::number(value[i]));
    return list;
}

/// Whether a word is a number in the form in which this program writes numbers. An item of a list
/// of texts may be either a number or a word.
bool is_as_written(const std::string& word) {
    if (const auto whole = whole_number<uint64_t>(word)) return number_text(*whole) == word;
    const auto number = finite_number(word);
    return number && number_text(*number) == word;
}

}  // namespace

void FieldWriter::operator()(std::string_view name, const double& value, Field field) {
    if (std::isinf(value)) return;
    mapping_.set(si_key(name, field.quantity), Node::number(value));
}

void FieldWriter::operator()(std::string_view name, const std::optional<double>& value,
                             Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const Vec3& value, Field field) {
    mapping_.set(si_key(name, field.quantity), exact(value));
}

void FieldWriter::operator()(std::string_view name, const Mat3& value, Field field) {
    Node rows;
    rows.kind = Node::Kind::sequence;
    for (int row = 0; row < 3; ++row) rows.items.push_back(exact(Vec3(value.row(row))));
    mapping_.set(si_key(name, field.quantity), rows);
}

void FieldWriter::operator()(std::string_view name, const std::optional<Vec3>& value, Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const Formula& value, Field field) {
    if (value.computed()) {
        mapping_.set(value.key, Node::of(value.text));
    } else {
        (*this)(name, value.value, field);
    }
}

void FieldWriter::operator()(std::string_view name, const std::optional<Formula>& value,
                             Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const FormulaVec3& value, Field field) {
    const bool computed = value[0].computed();
    Node list;
    list.kind = Node::Kind::sequence;
    for (const Formula& component : value)
        list.items.push_back(computed ? Node::of(component.text) : Node::number(component.value));
    mapping_.set(computed ? value[0].key : si_key(name, field.quantity), list);
}

void FieldWriter::operator()(std::string_view name, const std::optional<FormulaVec3>& value,
                             Field field) {
    if (value) (*this)(name, *value, field);
}

void FieldWriter::operator()(std::string_view name, const int& value, Field) {
    mapping_.set(std::string(name), Node::plain_word(number_text(value)));
}

void FieldWriter::operator()(std::string_view name, const bool& value, Field) {
    mapping_.set(std::string(name), Node::plain_word(value ? "yes" : "no"));
}

void FieldWriter::operator()(std::string_view name, const std::string& value, Field field) {
    if (value.empty()) return;
    // a number that is stored as text because of its size can be recognised because its field has
    // bounds
    const bool number = std::isfinite(field.min) && is_as_written(value);
    mapping_.set(std::string(name), number ? Node::plain_word(value) : Node::of(value));
}

void FieldWriter::operator()(std::string_view name, const std::vector<std::string>& value, Field) {
    Node list;
    list.kind = Node::Kind::sequence;
    const bool numbers = std::all_of(value.begin(), value.end(), is_as_written);
    for (const std::string& item : value)
        list.items.push_back(numbers ? Node::plain_word(item) : Node::of(item));
    if (!list.items.empty()) mapping_.set(std::string(name), list);
}

void FieldWriter::operator()(std::string_view name, const Texts& value, Field field) {
    if (value.size() == 1) {
        (*this)(name, value.front(), field);
    } else {
        (*this)(name, static_cast<const std::vector<std::string>&>(value), field);
    }
}

void FieldWriter::operator()(std::string_view name, const std::vector<double>& value, Field field) {
    Node list;
    list.kind = Node::Kind::sequence;
    for (const double item : value) list.items.push_back(Node::number(item));
    if (!list.items.empty()) mapping_.set(si_key(name, field.quantity), list);
}

void FieldWriter::operator()(std::string_view name, const Node& value, Field) {
    if (value.kind != Node::Kind::null) mapping_.set(std::string(name), value);
}

}  // namespace dihaptic
