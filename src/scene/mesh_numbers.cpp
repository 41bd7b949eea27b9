#include "scene/mesh_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/number.h"
#include "base/text_file.h"

namespace dihaptic::scene {
namespace {

using Words = std::vector<std::string_view>;

/// Reads a text line by line, leaving out comments. In OBJ files, a backslash continues a line.
class WordLines {
  public:
    WordLines(std::string_view text, bool continues) : text_(text), continues_(continues) {}

    /// Reads the next line. Returns false at the end of the text.
    bool next(Words& words) {
        words.clear();
        number_ += passed_;
        if (at_ >= text_.size()) return false;
        passed_ = 1;
        size_t end = end_of_line(at_);
        for (; is_continued(end); ++passed_) end = end_of_line(end + 1);
        split(text_.substr(at_, end - at_), words);
        at_ = end + 1;
        return true;
    }
    /// Like next(), but skips empty lines.
    bool next_filled(Words& words) {
        while (next(words)) {
            if (!words.empty()) return true;
        }
        return false;
    }
    /// Number of the line that next() returned last.
    int number() const { return number_; }
    /// Position at which the next line starts.
    size_t at() const { return at_; }

  private:
    size_t end_of_line(size_t begin) const {
        return std::min(text_.find('\n', begin), text_.size());
    }
    bool is_continued(size_t end) const {
        if (!continues_ || end >= text_.size()) return false;
        const size_t last = text_.substr(0, end).find_last_not_of('\r');
        return last != std::string_view::npos && text_[last] == '\\';
    }
    void split(std::string_view line, Words& words) const {
        const std::string_view blank = continues_ ? " \t\r\n\\" : " \t\r\n";
        for (size_t begin = 0, end = 0;; begin = end) {
            begin = line.find_first_not_of(blank, begin);
            if (begin == std::string_view::npos || line[begin] == '#') return;
            end = std::min(line.find_first_of(blank, begin), line.size());
            words.push_back(line.substr(begin, end - begin));
        }
    }

    std::string_view text_;
    bool continues_;
    size_t at_ = 0;
    int number_ = 1;
    int passed_ = 0;  // number of lines read by the last call
};

/// A vertex as written in a file: x, y and z, and whether a fourth number scales them.
struct Said {
    std::array<std::string_view, 3> xyz;
    bool is_scaled = false;
    int line = 0;
};

/// Checks a vertex. Returns its fault, or "" if there is none.
using Take = std::function<std::string(const Said&)>;

std::string has_too_few(size_t found, size_t wanted, int line) {
    return fmt::format("has {} of the {} numbers of a vertex in line {}", found, wanted, line);
}

/// Checks each vertex of an OBJ or STL file, where the lines of vertices start with a word.
std::string each_named(std::string_view text, std::string_view name, bool is_obj,
                       const Take& take) {
    WordLines lines(text, is_obj);
    for (Words words; lines.next(words);) {
        if (words.empty() || words[0] != name) continue;
        if (words.size() < 4) return has_too_few(words.size() - 1, 3, lines.number());
        std::string fault =
            take({{words[1], words[2], words[3]}, is_obj && words.size() == 5, lines.number()});
        if (!fault.empty()) return fault;
    }
    return "";
}

/// Checks each vertex of an OFF file. A malformed header is reported by the mesh reader.
std::string each_off(std::string_view text, const Take& take) {
    WordLines lines(text, false);
    Words words;
    if (!lines.next_filled(words)) return "";
    if (words[0].size() > 3 && words[0].starts_with("OFF")) {
        words[0].remove_prefix(3);  // as in ModelNet's files, where no space precedes the counts
    } else if (words[0].ends_with("OFF")) {
        if (words[0].find_first_of("4n") != std::string_view::npos) return "";
        words.erase(words.begin());
        if (words.empty() && !lines.next_filled(words)) return "";
    }
    size_t left = whole_number<size_t>(words[0]).value_or(0);
    for (; left > 0 && lines.next_filled(words); --left) {
        if (words.size() < 3) return has_too_few(words.size(), 3, lines.number());
        std::string fault = take({{words[0], words[1], words[2]}, false, lines.number()});
        if (!fault.empty()) return fault;
    }
    return "";
}

/// How the header of a PLY file describes the vertices.
struct PlyHead {
    size_t before = 0;  // number of lines or other items between the header and the first vertex
    size_t count = 0;
    size_t numbers = 0;                          // number of values per vertex
    size_t bytes = 0;                            // number of bytes per vertex
    std::array<std::optional<size_t>, 3> xyz{};  // positions of x, y and z among the values
    std::array<size_t, 3> xyz_at{};              // positions of x, y and z among the bytes
    int doubles = 0;                             // number of coordinates in double precision
    std::string format;
    bool has_lists = false;
    size_t end = 0;  // position at which the header ends
};

size_t size_of(std::string_view type) {
    if (type.ends_with("64") || type == "double") return 8;
    if (type.ends_with("16") || type.ends_with("short")) return 2;
    return type.ends_with("8") || type.ends_with("char") ? 1 : 4;
}

void take_property(const Words& words, PlyHead& head) {
    const std::string_view name = words.back();
    const size_t size = size_of(words[1]);
    if (words[1] == "list") head.has_lists = true;
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
        const auto axis = static_cast<size_t>(name[0] - 'x');
        head.xyz[axis] = head.numbers;
        head.xyz_at[axis] = head.bytes;
        head.doubles += size == 8 ? 1 : 0;
    }
    ++head.numbers;
    head.bytes += size;
}

PlyHead head_of(std::string_view text) {
    PlyHead head;
    WordLines lines(text, false);
    bool is_vertex = false;
    for (Words words; lines.next(words) && (words.empty() || words[0] != "end_header");) {
        if (words.size() < 3) continue;
        if (words[0] == "format") head.format = words[1];
        if (words[0] == "element") {
            is_vertex = words[1] == "vertex";
            const size_t count = whole_number<size_t>(words[2]).value_or(0);
            if (is_vertex) head.count = count;
            if (!is_vertex && head.count == 0) head.before += count;
        }
        if (words[0] == "property" && is_vertex) take_property(words, head);
    }
    head.end = std::min(lines.at(), text.size());
    return head;
}

std::string each_ply(std::string_view text, const Take& take) {
    const PlyHead head = head_of(text);
    const auto& [x, y, z] = head.xyz;
    if (head.format != "ascii" || head.has_lists || !x || !y || !z) return "";
    WordLines lines(text.substr(head.end), false);
    const auto first = static_cast<int>(
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(head.end), '\n'));
    Words words;
    for (size_t i = 0; i < head.before; ++i) {
        if (!lines.next_filled(words)) return "";
    }
    for (size_t i = 0; i < head.count && lines.next_filled(words); ++i) {
        if (words.size() < head.numbers)
            return has_too_few(words.size(), head.numbers, first + lines.number());
        std::string fault =
            take({{words[*x], words[*y], words[*z]}, false, first + lines.number()});
        if (!fault.empty()) return fault;
    }
    return "";
}

std::string each_vertex(std::string_view text, const std::string& format, const Take& take) {
    if (format == "off") return each_off(text, take);
    if (format == "ply") return each_ply(text, take);
    return format == "obj" ? each_named(text, "v", true, take)
                           : each_named(text, "vertex", false, take);
}

/// The range of the vertices' coordinates.
struct Extent {
    std::array<double, 3> low;
    std::array<double, 3> high;
    double rounding = 0;  // largest rounding error of a coordinate in single precision
    bool is_scaled = false;

    Extent() {
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
    }
    void take(size_t axis, double value) {
        low[axis] = std::min(low[axis], value);
        high[axis] = std::max(high[axis], value);
        rounding =
            std::max(rounding, std::abs(value - static_cast<double>(static_cast<float>(value))));
    }
    std::string take(const Said& said) {
        for (size_t i = 0; i < 3; ++i) {
            const auto value = finite_number(said.xyz[i]);
            if (!value)
                return fmt::format("has a vertex that is not a number in line {}: '{}'", said.line,
                                   shortened(std::string(said.xyz[i])));
            take(i, *value);
        }
        is_scaled = is_scaled || said.is_scaled;
        return "";
    }
    /// Whether single precision is insufficient. In a mesh around its origin, the rounding error is
    /// a hundredth of this limit.
    bool is_far() const { return !is_scaled && rounding > 2e-7 * diagonal(); }
    std::array<double, 3> middle() const {
        return {std::round((low[0] + high[0]) / 2), std::round((low[1] + high[1]) / 2),
                std::round((low[2] + high[2]) / 2)};
    }

    bool is_empty() const { return low[0] > high[0]; }
    double diagonal() const {
        return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    }
};

/// Returns the text with all coordinates relative to the point `from`.
std::string counted_from(const std::array<double, 3>& from, const std::string& text,
                         const std::string& format) {
    std::string out;
    size_t done = 0;
    each_vertex(text, format, [&](const Said& said) {
        std::array<std::pair<size_t, size_t>, 3> places;  // position and axis of each coordinate
        for (size_t i = 0; i < 3; ++i)
            places[i] = {static_cast<size_t>(said.xyz[i].data() - text.data()), i};
        std::sort(places.begin(), places.end());
        for (const auto& [at, axis] : places) {
            const double value = finite_number(said.xyz[axis]).value_or(0);
            out.append(text, done, at - done);
            out += number_text(value - from[axis]);
            done = at + said.xyz[axis].size();
        }
        return std::string();
    });
    return out.append(text, done);
}

/// Calls change(axis, coordinate) for all coordinates in a binary PLY file whose vertices come
/// first and are in double precision.
template <class Change>
void each_double(std::string& bytes, const PlyHead& head, const Change& change) {
    const bool is_swapped =
        (head.format == "binary_big_endian") == (std::endian::native == std::endian::little);
    for (size_t i = 0; i < head.count; ++i) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const size_t at = head.end + i * head.bytes + head.xyz_at[axis];
            std::array<char, sizeof(double)> stored{};
            if (at + stored.size() > bytes.size()) return;
            std::copy_n(bytes.data() + at, stored.size(), stored.begin());
            if (is_swapped) std::reverse(stored.begin(), stored.end());
            auto value = std::bit_cast<double>(stored);
            change(axis, value);
            stored = std::bit_cast<std::array<char, sizeof(double)>>(value);
            if (is_swapped) std::reverse(stored.begin(), stored.end());
            std::copy_n(stored.begin(), stored.size(), bytes.data() + at);
        }
    }
}

MeshNumbers look_at_doubles(std::string& bytes) {
    MeshNumbers out;
    const PlyHead head = head_of(bytes);
    if (!head.format.starts_with("binary") || head.doubles < 3 || head.has_lists || head.before > 0)
        return out;
    Extent extent;
    each_double(bytes, head, [&](size_t axis, double value) { extent.take(axis, value); });
    if (!extent.is_far()) return out;
    out.from = extent.middle();
    each_double(bytes, head, [&](size_t axis, double& value) { value -= out.from[axis]; });
    return out;
}

}  // namespace

MeshNumbers look_at_numbers(std::string& bytes, const std::string& format) {
    Extent extent;
    MeshNumbers out;
    out.fault = each_vertex(bytes, format, [&](const Said& said) { return extent.take(said); });
    if (!out.fault.empty()) return out;
    if (format == "ply" && extent.is_empty()) return look_at_doubles(bytes);
    if (extent.is_far()) {
        out.from = extent.middle();
        bytes = counted_from(out.from, bytes, format);
    }
    return out;
}

}  // namespace dihaptic::scene
