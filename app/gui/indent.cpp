#include "indent.h"

#include <QRegularExpression>

namespace dihaptic::gui {
namespace {

constexpr int kIndent = 2;

/// Whether the text has a bracket that is still open at its end.
bool is_open(const QString& text) {
    return text.count('{') + text.count('[') > text.count('}') + text.count(']');
}

}  // namespace

int indent_after(const QString& line) {
    static const QRegularExpression comment(R"((^|\s)#.*$)");
    static const QRegularExpression leading(R"(^( *)((?:- +)*))");
    static const QRegularExpression is_key(R"(^("[^"]*"|'[^']*'|[^\s{\["'][^{\["']*?):(\s|$))");
    static const QRegularExpression opens(R"((:|:\s+[|>][+-]?|^-)$)");
    const QString text = QString(line).remove(comment);
    const auto begin = leading.match(text);
    const auto spaces = static_cast<int>(begin.capturedLength(1));
    const auto content = static_cast<int>(begin.capturedLength(0));
    const QString what = text.mid(content).trimmed();
    if (what.isEmpty()) return content;
    if (opens.match(what).hasMatch() || is_open(what)) return content + kIndent;
    const bool is_item = content > spaces;
    if (is_item && !is_key.match(what).hasMatch())
        return content -
               static_cast<int>(begin.captured(2).size() - begin.captured(2).lastIndexOf('-'));
    return content;
}

}  // namespace dihaptic::gui
