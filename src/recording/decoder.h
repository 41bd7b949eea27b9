// Reads frames according to the schema stored in their log, so that recordings remain readable by
// later versions of the program. A field that exists only in the log is skipped; a field that
// exists only in Frame keeps its default value.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recording/codec.h"

namespace dihaptic::recording {

class FrameDecoder {
  public:
    /// Throws an Error that names `file` if `schema` is not a schema of frames.
    FrameDecoder(const std::string& schema, const std::string& file);

    /// Decodes a frame over the previous one. Returns false if the bytes are not a frame with this
    /// layout.
    bool decode(std::span<const std::byte> in, const Layout& layout, frame::Frame& frame) const;

    /// Frame fields that are missing from the log, such as "force_sent of fingers".
    const std::vector<std::string>& missing() const { return missing_; }
    /// Fields in the log that do not exist in a Frame.
    const std::vector<std::string>& unknown() const { return unknown_; }

  private:
    /// A run of bytes that are adjacent both in the log and in memory (in the Frame or in a list
    /// item).
    struct Piece {
        size_t size = 0;
        std::optional<size_t> to;  ///< offset in the Frame or the item; nullopt if skipped
    };
    /// A list within a Frame, whatever the type of its items.
    struct Target {
        size_t at = 0;      ///< offset of the list in the Frame
        size_t which = 0;   ///< offset of the list of changed indices, if the list has one
        size_t stride = 0;  ///< distance between consecutive items [bytes]
        size_t (*size)(const std::byte* list) = nullptr;
        /// Resizes the list and returns its first item.
        std::byte* (*resize)(std::byte* list, size_t count) = nullptr;
    };
    struct List {
        bool changed = false;  ///< the log contains only the items that changed, with their indices
        size_t item_bytes = 0;
        std::vector<Piece> pieces;
        std::optional<Target> target;  ///< unset: skipped
    };
    /// Fields of the Frame itself, followed by at most one list.
    struct Step {
        std::vector<Piece> pieces;
        std::optional<List> list;
    };
    class Members;
    class Source;
    class Builder;

    static bool read_list(const List& list, Source& source, std::byte* frame);
    static bool read_changed(const List& list, Source& source, std::byte* frame);

    std::vector<Step> steps_;
    std::vector<std::string> missing_;
    std::vector<std::string> unknown_;
};

}  // namespace dihaptic::recording
