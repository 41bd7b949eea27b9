#include "scene/body_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/number.h"
#include "base/text_file.h"
#include "base/unit.h"

namespace dihaptic::scene {
namespace {

/// The fields of a body that this file can change.
struct WrittenField {
    std::string_view name;
    Quantity quantity;
    double step;              ///< changed values are rounded to a multiple of this step [SI]
    std::string_view suffix;  ///< unit to use if no body in the file has this field
};
constexpr WrittenField kWrittenPosition{"position", Quantity::length, 1e-4, "mm"};
constexpr WrittenField kWrittenRotation{"rotation", Quantity::angle, 0.1 * kDegree, "deg"};

/// A vector-valued field of one body.
struct WrittenVector {
    const Written* list = nullptr;  ///< the list in the text; null if the body lacks the field
    Unit unit{};
};
WrittenVector find_vector(const Written& body, const WrittenField& field) {
    for (const Unit& unit : units(field.quantity)) {
        if (const Written* list = body.find(fmt::format("{}_{}", field.name, unit.suffix)))
            return {list, unit};
    }
    return {};
}

bool has_verbatim(const std::string& text, size_t at, const std::string& what) {
    return at <= text.size() && text.compare(at, what.size(), what) == 0;
}

class BodyText {
  public:
    BodyText(const std::string& text, const std::string& name)
        : text_(text), name_(name), root_(read_written(text)), body_(find_body()) {}

    /// Moves the value of a field by `way`. If the body does not have the field, adds it.
    void move(const WrittenField& field, const Vec3& way) {
        const auto [list, unit] = find_vector(body_, field);
        if (list == nullptr && way.isZero(0)) return;
        if (list == nullptr) return add(field, way);
        const Vec3 now = numbers(field, *list, unit);
        for (int i = 0; i < 3; ++i) {
            if (std::abs(way[i]) < 1e-3 * field.step) continue;
            const Written& item = list->items[static_cast<size_t>(i)];
            changes.push_back({item.at, item.scalar.size(), number(field, unit, now[i] + way[i])});
        }
    }
    /// The numbers in the field [SI]; zero if the body does not have the field.
    Vec3 value(const WrittenField& field) const {
        const auto [list, unit] = find_vector(body_, field);
        return list == nullptr ? Vec3(Vec3::Zero()) : numbers(field, *list, unit);
    }

    std::vector<TextChange> changes;

  private:
    [[noreturn]] void refuse(const std::string& why, const std::string& remedy) const {
        throw Error(fmt::format("{} cannot be moved here: {}", name_, why), remedy);
    }

    const Written& find_body() const {
        const Written* const bodies = root_.find("bodies");
        if (bodies == nullptr)
            refuse("this file has no bodies", "Open the scene that contains it.");
        for (const Written& body : bodies->items) {
            const Written* const name = body.find("name");
            if (name != nullptr && name->scalar == name_) return body;
        }
        if (const Written* const lattices = root_.find("lattices")) {
            for (const Written& lattice : lattices->items) {
                const Written* const name = lattice.find("name");
                if (name != nullptr && name_.starts_with(name->scalar + "_"))
                    refuse(fmt::format("it is a part of the lattice {}", name->scalar),
                           "Change the lattice's position.");
            }
        }
        refuse("the text does not contain it", "Write it out as one of the bodies.");
    }

    Vec3 numbers(const WrittenField& field, const Written& list, const Unit& unit) const {
        const std::string remedy = fmt::format("Write {}_{}: [x, y, z].", field.name, unit.suffix);
        if (!list.alone)
            refuse(fmt::format("its {} has an anchor or an alias, so another value depends on it",
                               field.name),
                   remedy);
        if (list.items.size() != 3)
            refuse(fmt::format("its {} is not three numbers", field.name), remedy);
        Vec3 out;
        for (size_t i = 0; i < 3; ++i) {
            const Written& item = list.items[i];
            const auto value = finite_number(item.scalar);
            if (!item.alone || !value || !has_verbatim(text_, item.at, item.scalar))
                refuse(fmt::format("its {} is not three plain numbers", field.name), remedy);
            out[static_cast<int>(i)] = *value * unit.si;
        }
        return out;
    }

    /// Returns a value in a unit, rounded to the field's step, without trailing zeros.
    static std::string number(const WrittenField& field, const Unit& unit, double value) {
        const double step = field.step / unit.si;
        const int places = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
        const double rounded = std::round(value / field.step) * step;
        std::string out = fmt::format("{:.{}f}", rounded, places);
        if (places > 0) out.erase(out.find_last_not_of('0') + 1);
        if (out.back() == '.') out.pop_back();
        return out == "-0" ? "0" : out;
    }

    /// The unit in which other bodies give the field.
    Unit usual_unit(const WrittenField& field) const {
        for (const Written& body : root_.find("bodies")->items) {
            if (const WrittenVector other = find_vector(body, field); other.list != nullptr)
                return other.unit;
        }
        const auto all = units(field.quantity);
        return *std::find_if(all.begin(), all.end(),
                             [&](const Unit& unit) { return unit.suffix == field.suffix; });
    }

    /// Inserts the field after the body's name, which always exists, in the mapping's own style.
    void add(const WrittenField& field, const Vec3& value) {
        const Unit unit = usual_unit(field);
        const std::string line = fmt::format(
            "{}_{}: [{}, {}, {}]", field.name, unit.suffix, number(field, unit, value[0]),
            number(field, unit, value[1]), number(field, unit, value[2]));
        const size_t end = end_of_name();
        if (body_.flow) return changes.push_back({end, 0, ", " + line});
        size_t next = std::min(text_.find('\n', end), text_.size());
        if (next > end && text_[next - 1] == '\r') --next;
        const std::string eol = text_.find("\r\n") != std::string::npos ? "\r\n" : "\n";
        const std::string indent(static_cast<size_t>(body_.items.front().column), ' ');
        changes.push_back({next, 0, eol + indent + line});
    }

    size_t end_of_name() const {
        const Written& name = *body_.find("name");
        const char first = name.at < text_.size() ? text_[name.at] : '\0';
        const bool quoted = first == '"' || first == '\'';
        const size_t begin = name.at + (quoted ? 1 : 0), end = begin + name.scalar.size();
        const bool closed = !quoted || (end < text_.size() && text_[end] == first);
        if (!name.alone || !has_verbatim(text_, begin, name.scalar) || !closed)
            refuse("it has no such key yet, and its name is not a plain word",
                   "Write its position_mm: [x, y, z], or its rotation_deg.");
        return end + (quoted ? 1 : 0);
    }

    const std::string& text_;
    const std::string& name_;
    Written root_;
    const Written& body_;
};

/// The equivalent angle between -pi and pi; a half turn keeps its sign.
double wrapped(double angle) {
    return std::abs(angle) <= kDegree * 180 ? angle : std::remainder(angle, kDegree * 360);
}

/// Whether a text, which may have become invalid YAML, has this value in a body's field.
bool has_value(const std::string& text, const std::string& name, const WrittenField& field,
               const Vec3& value) {
    try {
        return (BodyText(text, name).value(field) - value).cwiseAbs().maxCoeff() <= field.step;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

std::string body_at(const std::string& text, size_t at) {
    try {
        const Written root = read_written(text);
        // a section extends from the last key before the position to the next key
        const Written* section = nullptr;
        for (size_t i = 0; i + 1 < root.items.size(); i += 2) {
            if (root.items[i].at <= at) section = &root.items[i];
        }
        if (section == nullptr || section->scalar != "bodies") return "";
        std::string out;
        size_t before = section->at;
        for (const Written& body : root.find("bodies")->items) {
            // a body starts at the start of its line, unless another item is on that line
            const size_t line = text.rfind('\n', body.at) + 1;
            if (at < (line > before ? line : body.at)) break;
            before = body.at;
            const Written* const name = body.find("name");
            out = name == nullptr ? "" : name->scalar;
        }
        return out;
    } catch (const Error&) {
        return "";
    }
}

std::vector<TextChange> moved_body(const std::string& text, const std::string& name,
                                   const Vec3& way, double turn) {
    BodyText body(text, name);
    std::vector<std::pair<WrittenField, Vec3>> wanted;
    const auto move = [&](const WrittenField& field, const Vec3& by) {
        body.move(field, by);
        wanted.emplace_back(field, body.value(field) + by);
    };
    move(kWrittenPosition, way);
    if (turn != 0) {
        const double now = body.value(kWrittenRotation).z();
        move(kWrittenRotation, {0, 0, wrapped(now + turn) - now});
    }
    std::stable_sort(body.changes.begin(), body.changes.end(),
                     [](const TextChange& a, const TextChange& b) { return a.at < b.at; });
    const std::string after = changed(text, body.changes);
    for (const auto& [field, value] : wanted) {
        if (has_value(after, name, field, value)) continue;
        throw Error(name + " cannot be moved here: the text is too unusual",
                    fmt::format("Write its {} by hand.", field.name));
    }
    return std::move(body.changes);
}

}  // namespace dihaptic::scene
