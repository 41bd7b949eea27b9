#include "recording/decoder.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>
#include <utility>

#include "base/diagnostics.h"
#include "recording/schema.h"

namespace dihaptic::recording {
namespace {

using frame::Frame;

/// Size of a type named in a schema, such as "float64[3]"; nullopt if `type` is not a type.
std::optional<size_t> bytes_of(std::string_view type) {
    const size_t digits = std::min(type.find_first_of("0123456789"), type.size());
    const std::string_view kind = type.substr(0, digits);
    if (kind != "float" && kind != "int" && kind != "uint") return std::nullopt;
    const char* const end = type.data() + type.size();
    size_t bits = 0;
    const auto [rest, whole] = std::from_chars(type.data() + digits, end, bits);
    if (whole != std::errc() || (bits != 8 && bits != 16 && bits != 32 && bits != 64))
        return std::nullopt;
    if (rest == end) return bits / 8;
    constexpr size_t kMost = 1024;
    size_t count = 0;
    const auto [last, counted] = std::from_chars(rest + 1, end, count);
    if (*rest != '[' || counted != std::errc() || last == end || *last != ']' || count > kMost)
        return std::nullopt;
    return bits / 8 * count;
}

std::string first_word(const std::string& line) {
    return line.substr(0, line.find(' '));
}

/// A field of a Frame, or of an item of one of its lists.
struct Member {
    std::string line;  ///< the line that describes the field in the schema
    size_t at = 0;     ///< offset of the field in the Frame or the item
    bool recorded = false;
};

/// Finds the member described by this line of the schema, and marks it as recorded. Returns null if
/// there is none.
template <class Members>
auto* recorded(Members& members, const std::string& line) {
    const auto found = std::find_if(members.begin(), members.end(),
                                    [&](const auto& member) { return member.line == line; });
    if (found == members.end()) return static_cast<decltype(&*found)>(nullptr);
    found->recorded = true;
    return &*found;
}

}  // namespace

/// Lists the fields of a Frame, with their schema lines and their offsets in memory.
class FrameDecoder::Members {
  public:
    struct OfList {
        std::string line;
        Target target;
        std::vector<Member> fields;  ///< fields of each item in the list
        bool recorded = false;
    };

    Members() { Frame::visit(frame_, *this); }

    std::vector<Member> fields;
    std::vector<OfList> lists;

    template <class T>
    void operator()(const T& value, const frame::Term& term) {
        into_->push_back({schema_line<T>(term), offset(value)});
    }
    template <class T>
    void each(const char* name, const std::vector<T>& list, const char*) {
        add_list(schema_line(name, false), list, 0);
    }
    template <class T>
    void changed(const char* name, const std::vector<T>& list, const std::vector<uint16_t>& which,
                 const char*) {
        add_list(schema_line(name, true), list, offset(which));
    }

  private:
    template <class T>
    static const std::byte* bytes(const T& value) {
        return reinterpret_cast<const std::byte*>(&value);
    }
    template <class T>
    size_t offset(const T& value) const {
        return static_cast<size_t>(bytes(value) - begin_);
    }
    template <class T>
    void add_list(const std::string& line, const std::vector<T>& list, size_t which) {
        using Items = std::vector<T>;
        OfList& out = lists.emplace_back();
        out.line = line;
        out.target = {offset(list), which, sizeof(T)};
        out.target.size = [](const std::byte* at) {
            return reinterpret_cast<const Items*>(at)->size();
        };
        out.target.resize = [](std::byte* at, size_t count) {
            auto& items = *reinterpret_cast<Items*>(at);
            items.resize(count);
            return reinterpret_cast<std::byte*>(items.data());
        };
        const T item{};
        begin_ = bytes(item);
        into_ = &out.fields;
        T::visit(item, *this);
        begin_ = bytes(frame_);
        into_ = &fields;
    }

    const Frame frame_;
    const std::byte* begin_ = bytes(frame_);  // start of the Frame or item that is being visited
    std::vector<Member>* into_ = &fields;
};

/// The bytes of an encoded frame, read from front to back.
class FrameDecoder::Source {
  public:
    explicit Source(std::span<const std::byte> bytes) : rest_(bytes) {}

    /// Copies the next bytes to their places in memory; returns false if too few bytes are left.
    bool take(const std::vector<Piece>& pieces, std::byte* to) {
        for (const Piece& piece : pieces) {
            if (rest_.size() < piece.size) return false;
            if (piece.to) std::memcpy(to + *piece.to, rest_.data(), piece.size);
            rest_ = rest_.subspan(piece.size);
        }
        return true;
    }
    bool take(uint16_t& value) {
        if (rest_.size() < sizeof(value)) return false;
        std::memcpy(&value, rest_.data(), sizeof(value));
        rest_ = rest_.subspan(sizeof(value));
        return true;
    }
    bool has(size_t bytes) const { return rest_.size() >= bytes; }
    bool empty() const { return rest_.empty(); }

  private:
    std::span<const std::byte> rest_;
};

/// Reads a schema line by line and notes which of its fields exist in a Frame.
class FrameDecoder::Builder {
  public:
    Builder(FrameDecoder& out, const std::string& file) : out_(out), file_(file) {
        out_.steps_.emplace_back();
    }

    void add(std::string line) {
        const bool of_item = line.starts_with("  ");
        if (of_item) line.erase(0, 2);
        const std::string rest = line.substr(std::min(first_word(line).size() + 1, line.size()));
        const bool changed = rest == kChangedFollow;
        if (!of_item && (changed || rest == kEachFollows)) return begin_list(line, changed);
        const std::optional<size_t> size = bytes_of(first_word(rest));
        if (!size || (of_item && !out_.steps_.back().list)) throw unreadable();
        if (of_item) {
            add_to_list(line, *size);
        } else {
            add_own(line, *size);
        }
    }

    /// Notes which fields of a Frame are missing from the schema.
    void finish() {
        for (const Member& field : members_.fields) {
            if (field.recorded) continue;
            out_.missing_.push_back(first_word(field.line));
            // Without these two fields, frames cannot be told apart.
            if (field.line.starts_with("sequence ") || field.line.starts_with("time "))
                throw unreadable();
        }
        for (const Members::OfList& list : members_.lists) {
            const std::string name = first_word(list.line);
            if (!list.recorded) out_.missing_.push_back(name);
            for (const Member& field : list.fields) {
                if (list.recorded && !field.recorded)
                    out_.missing_.push_back(first_word(field.line) + " of " + name);
            }
        }
    }

  private:
    void begin_list(const std::string& line, bool changed) {
        list_ = recorded(members_.lists, line);
        list_name_ = first_word(line);
        if (list_ == nullptr) out_.unknown_.push_back(list_name_);
        if (out_.steps_.back().list) out_.steps_.emplace_back();
        List& list = out_.steps_.back().list.emplace(List{});
        list.changed = changed;
        if (list_ != nullptr) list.target = list_->target;
    }
    void add_to_list(const std::string& line, size_t size) {
        const Member* const member = list_ ? recorded(list_->fields, line) : nullptr;
        if (list_ != nullptr && member == nullptr)
            out_.unknown_.push_back(first_word(line) + " of " + list_name_);
        List& list = *out_.steps_.back().list;
        append(list.pieces, size, member);
        list.item_bytes += size;
    }
    void add_own(const std::string& line, size_t size) {
        const Member* const member = recorded(members_.fields, line);
        if (member == nullptr) out_.unknown_.push_back(first_word(line));
        if (out_.steps_.back().list) out_.steps_.emplace_back();
        append(out_.steps_.back().pieces, size, member);
    }
    static void append(std::vector<Piece>& pieces, size_t size, const Member* member) {
        const std::optional<size_t> to = member ? std::optional(member->at) : std::nullopt;
        const Piece* const last = pieces.empty() ? nullptr : &pieces.back();
        const bool goes_on = last != nullptr && to.has_value() == last->to.has_value() &&
                             (!to || *to == *last->to + last->size);
        if (goes_on) {
            pieces.back().size += size;
        } else {
            pieces.push_back({size, to});
        }
    }
    Error unreadable() const {
        return Error({file_, 0}, "schema", "does not describe the contents of its frames",
                     "Replace it with a backup.");
    }

    FrameDecoder& out_;
    std::string file_;
    Members members_;
    Members::OfList* list_ = nullptr;  // the current list; null if a Frame has no such list
    std::string list_name_;
};

FrameDecoder::FrameDecoder(const std::string& schema, const std::string& file) {
    Builder builder(*this, file);
    std::istringstream lines(schema);
    for (std::string line; std::getline(lines, line);) builder.add(line);
    builder.finish();
}

bool FrameDecoder::read_list(const List& list, Source& source, std::byte* frame) {
    uint16_t count = 0;
    if (!source.take(count) || !source.has(count * list.item_bytes)) return false;
    std::byte* item = list.target ? list.target->resize(frame + list.target->at, count) : nullptr;
    for (uint16_t n = 0; n < count; ++n) {
        if (!source.take(list.pieces, item)) return false;
        if (list.target) item += list.target->stride;
    }
    return true;
}

/// Reads the items that changed; all others keep their values.
bool FrameDecoder::read_changed(const List& list, Source& source, std::byte* frame) {
    uint16_t count = 0;
    if (!source.take(count)) return false;
    std::byte* first = nullptr;
    size_t size = 0;
    std::vector<uint16_t>* which = nullptr;
    if (list.target) {
        std::byte* const items = frame + list.target->at;
        size = list.target->size(items);
        first = list.target->resize(items, size);
        which = reinterpret_cast<std::vector<uint16_t>*>(frame + list.target->which);
        which->clear();
    }
    for (uint16_t n = 0; n < count; ++n) {
        uint16_t index = 0;
        if (!source.take(index) || (list.target && index >= size)) return false;
        std::byte* const item = list.target ? first + index * list.target->stride : nullptr;
        if (!source.take(list.pieces, item)) return false;
        if (which != nullptr) which->push_back(index);
    }
    return true;
}

bool FrameDecoder::decode(std::span<const std::byte> in, const Layout& layout,
                          frame::Frame& frame) const {
    frame.bodies.resize(layout.bodies);
    Source source(in);
    auto* const begin = reinterpret_cast<std::byte*>(&frame);
    for (const Step& step : steps_) {
        if (!source.take(step.pieces, begin)) return false;
        if (!step.list) continue;
        const auto read = step.list->changed ? read_changed : read_list;
        if (!read(*step.list, source, begin)) return false;
    }
    return source.empty() && frame.fingers.size() == layout.fingers &&
           frame.turns.size() == layout.turns && frame.joints.size() == layout.joints;
}

}  // namespace dihaptic::recording
