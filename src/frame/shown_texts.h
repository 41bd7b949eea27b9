// The texts that a Frame shows over the scene. A text of the session's list may have placeholders
// for numbers, such as {score} or {time_s:.1f}; the Frame contains the numbers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame/task_frame.h"

namespace dihaptic::frame {

/// A placeholder for a number in a text.
struct Placeholder {
    size_t begin = 0;   ///< index of the opening brace
    size_t end = 0;     ///< index after the closing brace
    std::string name;   ///< empty: malformed
    int decimals = -1;  ///< -1: as many as needed, four digits in total
};

/// The placeholders of a text, in order. Doubled braces stand for braces, not for placeholders.
std::vector<Placeholder> placeholders(std::string_view text);

/// The text with numbers in place of its placeholders, or a dash for NaN. Placeholders without
/// numbers remain unchanged. The numbers used are removed from `numbers`.
std::string filled(std::string_view text, std::span<const NumberFrame>& numbers);

/// The displayed texts: the message, if any, then the lines below it. `messages` is
/// the session's list; a text that is not in it appears as its index.
std::vector<std::string> shown_texts(const TaskFrame& task,
                                     const std::vector<std::string>& messages);

}  // namespace dihaptic::frame
