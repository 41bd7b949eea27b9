#include "recording/codec.h"

#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace dihaptic::recording {
namespace {

using frame::Frame;

static_assert(sizeof(Vec3) == 24 && sizeof(Quat) == 32 && sizeof(Time) == 8);

/// Size of a field in the log [bytes].
template <class T>
constexpr bool kIsField =
    std::is_trivially_copyable_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>;

class Writer {
  public:
    Writer(std::span<std::byte> out, Bodies bodies) : out_(out), bodies_(bodies) {}

    template <class T>
    void operator()(const T& value, const frame::Term&) {
        put(value);
    }
    template <class T>
    void each(const char*, const std::vector<T>& list, const char*) {
        fit(list.size());
        put(static_cast<uint16_t>(list.size()));
        for (const T& item : list) T::visit(item, *this);
    }
    template <class T>
    void changed(const char*, const std::vector<T>& list, const std::vector<uint16_t>& which,
                 const char*) {
        const bool all = bodies_ == Bodies::all;
        fit(list.size());
        const auto count = static_cast<uint16_t>(all ? list.size() : which.size());
        put(count);
        for (uint16_t n = 0; n < count; ++n) {
            const uint16_t i = all ? n : which[n];
            put(i);
            T::visit(list[i], *this);
        }
    }
    size_t size() const { return fits_ ? used_ : 0; }

  private:
    /// Counts are stored as 16-bit numbers. A frame with more items is dropped and reported,
    /// because it cannot be written correctly.
    void fit(size_t count) { fits_ = fits_ && count <= std::numeric_limits<uint16_t>::max(); }
    template <class T>
    void put(const T& value) {
        static_assert(kIsField<T>);
        if (used_ + sizeof(T) > out_.size()) fits_ = false;
        if (!fits_) return;
        std::memcpy(out_.data() + used_, &value, sizeof(T));
        used_ += sizeof(T);
    }
    std::span<std::byte> out_;
    Bodies bodies_;
    size_t used_ = 0;
    bool fits_ = true;
};

}  // namespace

size_t most_bytes(const Layout& layout, size_t contacts) {
    // the size is measured on a frame with the largest number of items in every list
    Frame frame;
    frame.fingers.resize(layout.fingers);
    frame.turns.resize(layout.turns);
    frame.bodies.resize(layout.bodies);
    frame.joints.resize(layout.joints);
    frame.contacts.resize(contacts);
    frame.task.fill({layout.bodies, layout.fingers});
    std::vector<std::byte> bytes(8192 + 512 * layout.fingers + 256 * layout.turns +
                                 448 * layout.bodies + 128 * layout.joints + 256 * contacts);
    return encode(frame, bytes, Bodies::all);
}

size_t encode(const Frame& frame, std::span<std::byte> out, Bodies bodies) noexcept {
    Writer writer(out, bodies);
    Frame::visit(frame, writer);
    return writer.size();
}

}  // namespace dihaptic::recording
