// Reads frames by the schema that their log carries, so that recordings outlive the program that
// made them. What a log has and a Frame has not is passed over; what a Frame has and the log has
// not keeps its default.
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
    /// Throws Error about `file`, the log, when that is no schema of frames.
    FrameDecoder(const std::string& schema, const std::string& file);

    /// Reads a frame onto the one before it; false when the bytes are no frame of this layout.
    bool decode(std::span<const std::byte> in, const Layout& layout, servo::Frame& frame) const;

    /// Fields of a Frame that the log does not have: "solver_route", "force_sent of fingers".
    const std::vector<std::string>& missing() const { return missing_; }
    /// Fields of the log that a Frame does not have.
    const std::vector<std::string>& unknown() const { return unknown_; }

  private:
    /// Bytes that follow each other in the log and in the Frame, or in the item of one of its
    /// lists.
    struct Piece {
        size_t size = 0;
        std::optional<size_t> to;  ///< from the Frame's, or the item's, first byte; unset: nowhere
    };
    /// A list of the Frame, whatever its items are.
    struct Target {
        size_t at = 0;     ///< the list, from the Frame's first byte
        size_t which = 0;  ///< the same of the indices of items that changed, of lists of these
        size_t stride = 0;
        size_t (*size)(const std::byte* list) = nullptr;
        /// Gives it so many items; the first one.
        std::byte* (*resize)(std::byte* list, size_t count) = nullptr;
    };
    struct List {
        bool changed = false;  ///< the log has those items that changed, with their indices
        size_t item_bytes = 0;
        std::vector<Piece> pieces;
        std::optional<Target> target;  ///< unset: nowhere
    };
    /// Fields of the Frame itself, then a list if one follows them.
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
