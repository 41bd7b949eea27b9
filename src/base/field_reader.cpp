#include "base/field_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/choices.h"
#include "base/number.h"
#include "base/text_file.h"

namespace dihaptic {
namespace {

std::vector<std::string> keys_of(const std::string& name, Quantity quantity) {
    std::vector<std::string> keys;
    for (const Unit& unit : units(quantity))
        keys.push_back(fmt::format("{}_{}", name, unit.suffix));
    if (keys.empty()) keys.push_back(name);
    return keys;
}

/// The keys of a field in short, e.g. "size_m/mm/cm".
std::string short_keys(const std::string& name, Quantity quantity) {
    std::vector<std::string_view> suffixes;
    for (const Unit& unit : units(quantity)) suffixes.push_back(unit.suffix);
    return suffixes.empty() ? name : fmt::format("{}_{}", name, fmt::join(suffixes, "/"));
}

/// The key that was probably meant: one that begins with the word, which may be half typed, or else
/// the nearest; "" if there is none.
std::string key_meant(const std::string& word, const std::vector<std::string>& keys) {
    constexpr size_t kLeast = 3;  // letters
    for (const std::string& key : keys) {
        if (word.size() >= kLeast && key.starts_with(word)) return key;
    }
    return nearest(word, keys);
}

std::string alternatives(const std::vector<std::string>& words) {
    if (words.size() == 1) return words.front();
    return fmt::format("{} or {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

std::string origin_of(const Place& place) {
    return place.line > 0 ? fmt::format("{}:{}", place.file, place.line) : place.file;
}

std::optional<double> number_in(const Node& node) {
    return node.kind == Node::Kind::scalar ? finite_number(node.scalar) : std::nullopt;
}

bool is_too_low(const Field& field, double si) {
    return field.above_min ? si <= field.min : si < field.min;
}

/// The bounds that a value violates, in words and in the unit in which the value was written.
std::string bounds_of(const Field& field, double si, double to_si) {
    const bool only_positive = field.above_min && field.min == 0 && std::isinf(field.max);
    const bool from_zero = field.min > 0 || field.above_min;
    if (only_positive || (is_too_low(field, si) && si <= 0 && from_zero)) return "positive";
    const double low = field.min / to_si;
    const double high = field.max / to_si;
    const char* from = field.above_min ? "above" : "at least";
    if (std::isinf(field.max)) return fmt::format("{} {:.9g}", from, low);
    if (std::isinf(field.min)) return fmt::format("at most {:.9g}", high);
    return fmt::format("{} {:.9g} and at most {:.9g}", from, low, high);
}

}  // namespace

FieldReader::FieldReader(const Node& mapping, Diagnostics& diagnostics, Origins* origins,
                         std::string path)
    : mapping_(mapping), diagnostics_(diagnostics), origins_(origins), path_(std::move(path)) {}

Place FieldReader::place() const {
    std::map<std::string, int> lines;
    for (const auto& [key, node] : mapping_.entries) lines.emplace(key, node.place.line);
    Place out = mapping_.place;
    out.keys = std::make_shared<const std::map<std::string, int>>(std::move(lines));
    return out;
}

Place FieldReader::place_of(std::string_view name) const {
    const std::string start = std::string(name) + "_";
    for (const auto& [key, node] : mapping_.entries) {
        if (key == name || key.starts_with(start)) return node.place;
    }
    return mapping_.place;
}

bool FieldReader::mentions(std::string_view name) const {
    return std::any_of(mapping_.entries.begin(), mapping_.entries.end(), [&](const auto& entry) {
        return entry.key == name || entry.key.starts_with(std::string(name) + "_");
    });
}

bool FieldReader::is_list(std::string_view name) const {
    const Node* node = mapping_.find(std::string(name));
    return node != nullptr && node->kind == Node::Kind::sequence;
}

bool FieldReader::has(std::string_view name, Quantity quantity) const {
    for (const std::string& key : keys_of(std::string(name), quantity)) {
        if (mapping_.find(key) != nullptr) return true;
    }
    return false;
}

FieldReader::Given FieldReader::take(std::string_view name, const Field& field) {
    fields_.push_back({std::string(name), field.quantity, field.what});
    Given given;
    const auto all = units(field.quantity);
    const std::vector<std::string> keys = keys_of(std::string(name), field.quantity);
    for (size_t i = 0; i < keys.size(); ++i) {
        const Node* node = mapping_.find(keys[i]);
        if (node == nullptr) continue;
        used_.insert(keys[i]);
        if (given.node != nullptr) {
            diagnostics_.error(node->place, keys[i],
                               fmt::format("the same {} is also given as {}", name, given.key),
                               "Keep one of the two.");
            continue;
        }
        given = {node, keys[i], all.empty() ? 1.0 : all[i].si};
    }
    if (field.old_name != nullptr) given = take_old(name, field, given);
    // finish() reports a key with a wrong or missing unit, so it does not count as missing
    const bool misspelt = place_of(name).line != mapping_.place.line;
    if (given.node == nullptr && field.is_required && !misspelt) {
        diagnostics_.error(mapping_.place, std::string(name), "is missing",
                           fmt::format("Add {}.", alternatives(keys)));
    }
    if (given.node != nullptr) note_origin(name, *given.node);
    return given;
}

FieldReader::Given FieldReader::take_old(std::string_view name, const Field& field, Given given) {
    const auto all = units(field.quantity);
    const std::vector<std::string> old = keys_of(field.old_name, field.quantity);
    const std::vector<std::string> now = keys_of(std::string(name), field.quantity);
    for (size_t i = 0; i < old.size(); ++i) {
        const Node* node = mapping_.find(old[i]);
        if (node == nullptr || !used_.insert(old[i]).second) continue;
        if (given.node != nullptr) {
            diagnostics_.error(node->place, old[i],
                               fmt::format("the same {} is also given as {}", name, given.key),
                               fmt::format("Keep {}.", now[i]));
            continue;
        }
        if (diagnostics_.unknown_keys() == UnknownKeys::are_errors) {
            diagnostics_.warning(node->place, old[i], fmt::format("is now called {}", now[i]),
                                 fmt::format("Write {}.", now[i]));
        }
        given = {node, old[i], all.empty() ? 1.0 : all[i].si};
    }
    return given;
}

void FieldReader::note_origin(std::string_view name, const Node& node) {
    if (origins_ == nullptr) return;
    const std::string path = path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
    (*origins_)[path] = origin_of(node.place);
}

std::optional<double> FieldReader::number(const Given& given, const Node& node,
                                          const Field& field) {
    const auto value = number_in(node);
    if (!value) {
        const std::string shown = node.kind == Node::Kind::scalar
                                      ? "'" + shortened(node.scalar) + "'"
                                  : node.kind == Node::Kind::null ? "nothing"
                                                                  : "a list";
        diagnostics_.error(
            given.node->place, given.key, fmt::format("must be a number, but is {}", shown),
            field.quantity == Quantity::none ? "Write a number."
                                             : "Write the number alone; its unit is in the key.");
        return std::nullopt;
    }
    const double si = *value * given.to_si;
    if (!std::isfinite(si)) {
        diagnostics_.error(given.node->place, given.key,
                           fmt::format("is too large a number: {}", shortened(node.scalar)),
                           "Correct the value, or its unit.");
        return std::nullopt;
    }
    if (is_too_low(field, si) || si > field.max) {
        diagnostics_.error(given.node->place, given.key,
                           fmt::format("must be {}, but is {}", bounds_of(field, si, given.to_si),
                                       shortened(node.scalar)),
                           "Correct the value, or its unit.");
        return std::nullopt;
    }
    return si;
}

std::optional<Formula> FieldReader::formula(const Given& given, const Node& node,
                                            const Field& field) {
    Formula out;
    const bool text = node.kind == Node::Kind::scalar && !node.scalar.empty() && !number_in(node);
    if (text) {
        out.text = node.scalar;
    } else if (const auto value = number(given, node, field)) {
        out.value = *value;
    } else {
        return std::nullopt;
    }
    out.to_si = given.to_si;
    out.key = given.key;
    out.place = given.node->place;
    out.field = field;
    return out;
}

bool FieldReader::is_triple(const Given& given) {
    if (given.node->kind == Node::Kind::sequence && given.node->items.size() == 3) return true;
    diagnostics_.error(given.node->place, given.key, "must be three numbers",
                       fmt::format("Write {}: [x, y, z].", given.key));
    return false;
}

std::optional<Vec3> FieldReader::vector(const Given& given, const Field& field) {
    if (!is_triple(given)) return std::nullopt;
    Vec3 value;
    for (int i = 0; i < 3; ++i) {
        const auto component = number(given, given.node->items[static_cast<size_t>(i)], field);
        if (!component) return std::nullopt;
        value[i] = *component;
    }
    return value;
}

std::optional<std::string> FieldReader::word(const Given& given, const Field& field) {
    if (given.node->kind != Node::Kind::scalar) {
        diagnostics_.error(given.node->place, given.key, "must be a single word or text",
                           "Write one, in quotes if it contains punctuation.");
        return std::nullopt;
    }
    if (field.is_required && given.node->scalar.empty()) {
        diagnostics_.error(given.node->place, given.key, "is empty", "Give it a value.");
        return std::nullopt;
    }
    return given.node->scalar;
}

void FieldReader::operator()(std::string_view name, double& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = number(given, *given.node, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, std::optional<double>& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = number(given, *given.node, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, Vec3& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = vector(given, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, std::optional<Vec3>& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = vector(given, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, Formula& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = formula(given, *given.node, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, std::optional<Formula>& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = formula(given, *given.node, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, FormulaVec3& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = formulas(given, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, std::optional<FormulaVec3>& value,
                             Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = formulas(given, field)) value = *read;
    }
}

std::optional<FormulaVec3> FieldReader::formulas(const Given& given, const Field& field) {
    if (!is_triple(given)) return std::nullopt;
    FormulaVec3 components;
    bool computed = false;
    for (size_t i = 0; i < components.size(); ++i) {
        const auto component = formula(given, given.node->items[i], field);
        if (!component) return std::nullopt;
        components[i] = *component;
        computed = computed || component->computed();
    }
    for (size_t i = 0; computed && i < components.size(); ++i)
        components[i].text = given.node->items[i].scalar;
    return components;
}

void FieldReader::operator()(std::string_view name, Mat3& value, Field field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return;
    const auto is_row = [](const Node& node) {
        return node.kind == Node::Kind::sequence && node.items.size() == 3;
    };
    const Node& rows = *given.node;
    if (!is_row(rows) || !std::all_of(rows.items.begin(), rows.items.end(), is_row)) {
        diagnostics_.error(rows.place, given.key, "must be three rows of three numbers",
                           fmt::format("Write {}: [[0, 0, 0], [0, 0, 0], [0, 0, 0]].", given.key));
        return;
    }
    Mat3 out;
    for (int row = 0; row < 3; ++row) {
        const Node& numbers = rows.items[static_cast<size_t>(row)];
        const auto read = vector({&numbers, given.key, given.to_si}, field);
        if (!read) return;
        out.row(row) = *read;
    }
    value = out;
}

void FieldReader::operator()(std::string_view name, int& value, Field field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return;
    const auto read = number(given, *given.node, field);
    if (!read) return;
    if (*read != std::floor(*read) || std::abs(*read) > 1e9) {
        diagnostics_.error(given.node->place, given.key,
                           fmt::format("must be a whole number, but is {}", given.node->scalar),
                           "Leave out the decimals.");
        return;
    }
    value = static_cast<int>(*read);
}

void FieldReader::operator()(std::string_view name, bool& value, Field field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return;
    const std::string& text = given.node->scalar;
    if (text == "true" || text == "yes") {
        value = true;
    } else if (text == "false" || text == "no") {
        value = false;
    } else {
        diagnostics_.error(given.node->place, given.key,
                           fmt::format("must be yes or no, but is '{}'", text), "Write yes or no.");
    }
}

void FieldReader::operator()(std::string_view name, std::string& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) {
        if (const auto read = word(given, field)) value = *read;
    }
}

void FieldReader::operator()(std::string_view name, std::vector<std::string>& value, Field field) {
    const Node* list = take_list(name, field);
    if (list == nullptr) return;
    value.clear();
    for (const Node& item : list->items) {
        if (const auto read = word({&item, std::string(name), 1}, field)) value.push_back(*read);
    }
}

void FieldReader::operator()(std::string_view name, Texts& value, Field field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return;
    value.clear();
    const Node& node = *given.node;
    const auto read = [&](const Node& item) {
        const auto text = word({&item, given.key, 1}, field);
        if (text && !text->empty()) value.push_back(*text);
    };
    if (node.kind == Node::Kind::scalar) {
        read(node);
    } else if (node.kind == Node::Kind::sequence) {
        for (const Node& item : node.items) read(item);
    } else {
        diagnostics_.error(node.place, given.key, "must be a text or a list of texts",
                           fmt::format("Write {0}: a, or {0}: [a, b].", given.key));
    }
}

void FieldReader::operator()(std::string_view name, std::vector<double>& value, Field field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return;
    if (given.node->kind != Node::Kind::sequence || given.node->items.empty()) {
        diagnostics_.error(given.node->place, given.key, "must be a list of numbers",
                           fmt::format("Write {}: [0.2, 0.1].", given.key));
        return;
    }
    value.clear();
    for (const Node& item : given.node->items) {
        if (const auto read = number(given, item, field)) value.push_back(*read);
    }
}

void FieldReader::operator()(std::string_view name, Node& value, Field field) {
    if (const Given given = take(name, field); given.node != nullptr) value = *given.node;
}

void FieldReader::foreign(std::string_view name, const Field& field, const std::string& remedy) {
    std::vector<std::string> keys = keys_of(std::string(name), field.quantity);
    keys.emplace_back(name);
    for (const std::string& key : keys) {
        const Node* node = mapping_.find(key);
        if (node != nullptr && used_.insert(key).second)
            diagnostics_.unknown_key(node->place, key, remedy);
    }
}

const Node* FieldReader::take_mapping(std::string_view name, const Field& field) {
    const Given given = take(name, field);
    if (given.node == nullptr || !is_mapping(*given.node, given.key)) return nullptr;
    return given.node;
}

bool FieldReader::is_mapping(const Node& node, const std::string& key) {
    if (node.kind == Node::Kind::mapping) return true;
    diagnostics_.error(node.place, key, "must have keys of its own",
                       node.place.line > 0
                           ? "Write them below it, indented, one 'key: value' per line."
                           : fmt::format("Name one of them: {}.KEY=VALUE.", key));
    return false;
}

const Node* FieldReader::take_list(std::string_view name, const Field& field) {
    const Given given = take(name, field);
    if (given.node == nullptr) return nullptr;
    if (given.node->kind != Node::Kind::sequence) {
        diagnostics_.error(given.node->place, given.key, "must be a list",
                           "Start each of its items with a dash, or write [a, b].");
        return nullptr;
    }
    return given.node;
}

int FieldReader::read_choice(std::string_view name, const std::vector<std::string_view>& names,
                             const Field& field, const OldName& old) {
    const Given given = take(name, field);
    if (given.node == nullptr) return -1;
    for (size_t i = 0; i < names.size(); ++i) {
        if (given.node->kind == Node::Kind::scalar && given.node->scalar == names[i])
            return static_cast<int>(i);
    }
    const bool gone = !old.was.empty() && given.node->scalar == old.was;
    diagnostics_.error(
        given.node->place, given.key,
        fmt::format("'{}' is {}", given.node->scalar, gone ? "no longer allowed" : "not known"),
        gone ? std::string(old.remedy)
             : fmt::format("Use {}.", alternatives({names.begin(), names.end()})),
        choices_of(names));
    return -1;
}

std::vector<Choice> FieldReader::choices() const {
    std::vector<Choice> out;
    for (const Known& field : fields_) {
        const std::vector<std::string> keys = keys_of(field.name, field.quantity);
        const bool given = std::any_of(keys.begin(), keys.end(),
                                       [&](const std::string& key) { return used_.contains(key); });
        if (given) continue;
        for (const std::string& key : keys) out.push_back({key, std::string(field.what)});
    }
    return out;
}

void FieldReader::finish() {
    for (const auto& [key, node] : mapping_.entries) {
        if (used_.contains(key)) continue;
        const Known* field = nullptr;
        std::vector<std::string> known, in_short;
        for (const Known& candidate : fields_) {
            const bool same = key == candidate.name || (candidate.quantity != Quantity::none &&
                                                        key.starts_with(candidate.name + "_"));
            if (same && (field == nullptr || candidate.name.size() > field->name.size()))
                field = &candidate;
            for (std::string& name : keys_of(candidate.name, candidate.quantity))
                known.push_back(std::move(name));
            in_short.push_back(short_keys(candidate.name, candidate.quantity));
        }
        if (field != nullptr) {
            const bool bare = key == field->name;
            diagnostics_.error(
                node.place, key,
                bare ? "needs its unit in the key"
                     : fmt::format("is not a unit of {}", dihaptic::name(field->quantity)),
                fmt::format("Write {}.", alternatives(keys_of(field->name, field->quantity))));
            continue;
        }
        if (key.find_first_of("()") != std::string::npos) {
            diagnostics_.error(node.place, key, "was cut off from the text before it by a comma",
                               "Put that text in quotes, e.g. when: \"gripped(block, hand)\".");
            continue;
        }
        if (diagnostics_.problems().size() > kMostExplained) {
            diagnostics_.unknown_key(node.place, key, "");
            continue;
        }
        const std::string guess = key_meant(key, known);
        diagnostics_.unknown_key(node.place, key,
                                 guess.empty()
                                     ? fmt::format("Known: {}.", fmt::join(in_short, ", "))
                                     : fmt::format("Did you mean {}?", guess),
                                 choices());
    }
}

}  // namespace dihaptic
