// The texts that a Frame shows over the scene. A text in the session's list may contain
// placeholders for numbers, such as {score} or {time_s:.1f}; the numbers themselves are in the
// Frame.
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
    size_t end = 0;     ///< index of the first character after the closing brace
    std::string name;   ///< name of the number; empty if malformed
    int decimals = -1;  ///< number of decimals; -1: as many as needed, four digits in total
};

/// Returns the placeholders of a text, in order. A doubled brace stands for a literal brace and
/// does not start a placeholder.
std::vector<Placeholder> placeholders(std::string_view text);

/// Returns the text with numbers in place of its placeholders, or a dash in place of NaN.
/// Placeholders for which there is no number remain unchanged. The numbers that were used are
/// removed from `numbers`.
std::string filled(std::string_view text, std::span<const NumberFrame>& numbers);

/// Returns the displayed texts: the message, if any, then the lines below it. `messages` is the
/// session's list of texts; a text that is not in the list is shown as its index.
std::vector<std::string> shown_texts(const TaskFrame& task,
                                     const std::vector<std::string>& messages);

}  // namespace dihaptic::frame
