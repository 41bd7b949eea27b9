#include "recording/codec.h"

#include <cstring>
#include <sstream>

namespace dihaptic::recording {
namespace {

using servo::Frame;

static_assert(sizeof(Vec3) == 24 && sizeof(Quat) == 32 && sizeof(Time) == 8);

/// What a field takes in the log.
template <class T>
constexpr bool kIsField =
    std::is_trivially_copyable_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>;

class Writer {
  public:
    Writer(std::span<std::byte> out, Bodies bodies) : out_(out), bodies_(bodies) {}

    template <class T>
    void operator()(const char*, const T& value, const char*) {
        static_assert(kIsField<T>);
        put(&value, sizeof(T));
    }
    template <class T>
    void each(const char*, const std::vector<T>& list) {
        (*this)("", static_cast<uint16_t>(list.size()), "");
        for (const T& item : list) T::visit(item, *this);
    }
    template <class T>
    void changed(const char*, const std::vector<T>& list, const std::vector<uint16_t>& which) {
        const bool all = bodies_ == Bodies::all;
        const auto count = static_cast<uint16_t>(all ? list.size() : which.size());
        (*this)("", count, "");
        for (uint16_t n = 0; n < count; ++n) {
            const uint16_t i = all ? n : which[n];
            (*this)("", i, "");
            T::visit(list[i], *this);
        }
    }
    size_t size() const { return fits_ ? used_ : 0; }

  private:
    void put(const void* data, size_t size) {
        if (used_ + size > out_.size()) fits_ = false;
        if (!fits_) return;
        std::memcpy(out_.data() + used_, data, size);
        used_ += size;
    }
    std::span<std::byte> out_;
    Bodies bodies_;
    size_t used_ = 0;
    bool fits_ = true;
};

template <class T>
const char* type_name() {
    if constexpr (std::is_same_v<T, double>) return "float64";
    if constexpr (std::is_same_v<T, Vec3>) return "float64[3]";
    if constexpr (std::is_same_v<T, Quat>) return "float64[4] (x, y, z, w)";
    if constexpr (std::is_same_v<T, int64_t>) return "int64";
    if constexpr (std::is_same_v<T, int32_t>) return "int32";
    if constexpr (std::is_same_v<T, uint32_t>) return "uint32";
    if constexpr (std::is_same_v<T, Time>) return "int64";
    return "";
}

/// A field's line of the schema.
template <class T>
std::string line(const char* name, const char* unit) {
    return std::string(name) + " " + type_name<T>() + " " + unit;
}

class Reader {
  public:
    Reader(std::span<const std::byte> in, const MissingFields& missing)
        : in_(in), missing_(missing) {}

    template <class T>
    void operator()(const char* name, T& value, const char* unit) {
        if (!in_item_ && !missing_.empty() && missing_.contains(line<T>(name, unit))) return;
        if (used_ + sizeof(T) > in_.size()) good_ = false;
        if (!good_) return;
        std::memcpy(static_cast<void*>(&value), in_.data() + used_, sizeof(T));
        used_ += sizeof(T);
    }
    template <class T>
    void each(const char*, std::vector<T>& list) {
        uint16_t count = 0;
        (*this)("", count, "");
        if (!good_) return;
        list.resize(count);
        in_item_ = true;
        for (T& item : list) T::visit(item, *this);
        in_item_ = false;
    }
    template <class T>
    void changed(const char*, std::vector<T>& list, std::vector<uint16_t>& which) {
        uint16_t count = 0;
        (*this)("", count, "");
        which.clear();
        for (uint16_t n = 0; n < count && good_; ++n) {
            uint16_t i = 0;
            (*this)("", i, "");
            if (i >= list.size()) good_ = false;
            if (!good_) return;
            which.push_back(i);
            in_item_ = true;
            T::visit(list[i], *this);
            in_item_ = false;
        }
    }
    bool whole() const { return good_ && used_ == in_.size(); }

  private:
    std::span<const std::byte> in_;
    const MissingFields& missing_;
    size_t used_ = 0;
    bool good_ = true;
    bool in_item_ = false;  // of a list: only other fields can be missing
};

/// Lists fields; visits one item of each list.
class Lister {
  public:
    template <class T>
    void operator()(const char* name, const T&, const char* unit) {
        text_ += prefix_ + line<T>(name, unit) + "\n";
    }
    template <class T>
    void each(const char* name, const std::vector<T>&) {
        item<T>(name, "uint16 count, then each:");
    }
    template <class T>
    void changed(const char* name, const std::vector<T>&, const std::vector<uint16_t>&) {
        item<T>(name, "uint16 count, then uint16 index and item of each that changed:");
    }
    std::string take() { return std::move(text_); }

  private:
    template <class T>
    void item(const char* name, const char* how) {
        text_ += std::string(name) + " " + how + "\n";
        prefix_ = "  ";
        const T value{};
        T::visit(value, *this);
        prefix_.clear();
    }
    std::string text_;
    std::string prefix_;
};

}  // namespace

size_t most_bytes(const Layout& layout, size_t contacts) {
    // a frame with everything in it, measured
    Frame frame;
    frame.fingers.resize(layout.fingers);
    frame.turns.resize(layout.turns);
    frame.bodies.resize(layout.bodies);
    frame.contacts.resize(contacts);
    frame.task.visual.resize(1);
    frame.task.targets.resize(servo::TaskFrame::kMostTargets);
    frame.task.properties.resize(servo::TaskFrame::kMostProperties);
    frame.task.loads.resize(servo::TaskFrame::kMostLoads);
    frame.task.placements.resize(layout.bodies);
    std::vector<std::byte> bytes(8192 + 512 * layout.fingers + 256 * layout.turns +
                                 384 * layout.bodies + 256 * contacts);
    return encode(frame, bytes, Bodies::all);
}

size_t encode(const Frame& frame, std::span<std::byte> out, Bodies bodies) noexcept {
    Writer writer(out, bodies);
    Frame::visit(frame, writer);
    return writer.size();
}

bool decode(std::span<const std::byte> in, const Layout& layout, Frame& frame,
            const MissingFields& missing) {
    frame.bodies.resize(layout.bodies);
    Reader reader(in, missing);
    Frame::visit(frame, reader);
    return reader.whole() && frame.fingers.size() == layout.fingers &&
           frame.turns.size() == layout.turns;
}

std::string schema() {
    Lister lister;
    const Frame frame;
    Frame::visit(frame, lister);
    return lister.take();
}

std::optional<MissingFields> missing_fields(const std::string& recorded_schema) {
    const auto is_of_item = [](const std::string& text) { return text.starts_with(" "); };
    std::istringstream ours(schema());
    std::istringstream theirs(recorded_schema);
    MissingFields out;
    std::string their_line;
    bool has_more = static_cast<bool>(std::getline(theirs, their_line));
    for (std::string our_line; std::getline(ours, our_line);) {
        if (has_more && our_line == their_line) {
            has_more = static_cast<bool>(std::getline(theirs, their_line));
        } else if (is_of_item(our_line) || our_line.ends_with(":")) {
            return std::nullopt;  // of fingers, bodies and the like none was added yet
        } else {
            out.insert(our_line);
        }
    }
    if (has_more) return std::nullopt;
    return out;
}

}  // namespace dihaptic::recording
