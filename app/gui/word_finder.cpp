#include "word_finder.h"

#include <QRegularExpression>
#include <utility>

#include "base/unsaved.h"
#include "session/check.h"

namespace dihaptic::gui {
namespace {

/// Whether a character belongs to a word; block.z is one word.
bool is_letter(QChar c) {
    return c.isLetterOrNumber() || c == '_' || c == '.';
}

/// The context of a position in a text, derived from the text before it.
struct Around {
    QChar bracket;   // innermost open bracket; null if there is none
    QChar quote;     // quotation mark, if inside a quote; null if not
    QString before;  // text before the position, in its item in brackets or in its line
    QString close;   // characters that close the open quote and brackets

    QString dashes() const {
        static const QRegularExpression leading(R"(^\s*(-\s+)*)");
        return leading.match(before).captured();
    }
    /// Whether a word at this position is or may be a key.
    bool takes_key() const {
        static const QRegularExpression key(R"(:\s)");
        if (!quote.isNull()) return false;
        return bracket == '{' ? !before.contains(key)
                              : bracket.isNull() && dashes().size() == before.size();
    }
    /// Whether a word at this position may be an item of a list with dashes.
    bool takes_item() const { return bracket.isNull() && dashes().contains('-'); }
};

class AroundFinder {
  public:
    AroundFinder(const QString& text, int at) : text_(text), at_(at) {}

    Around find() {
        for (int i = 0; i < at_; ++i) take(i);
        const int item = open_.empty() ? line_ : open_.back().second;
        Around out{open_.empty() ? QChar() : open_.back().first, quote_,
                   text_.mid(item, at_ - item), ""};
        if (!quote_.isNull()) out.close += quote_;
        for (auto open = open_.rbegin(); open != open_.rend(); ++open)
            out.close += open->first == '[' ? ']' : '}';
        return out;
    }

  private:
    void take(int i) {
        const QChar c = text_[i];
        const bool ends_word = i + 1 >= at_ || text_[i + 1].isSpace();
        if (!quote_.isNull()) {
            const bool escaped = quote_ == '"' && text_[i - 1] == '\\';
            if (c == quote_ && !escaped) quote_ = QChar();
        } else if (c == '\n') {
            comment_ = false;
            begins_ = true;
            line_ = i + 1;
        } else if (comment_ || (c == '#' && (i == 0 || text_[i - 1].isSpace()))) {
            comment_ = true;
        } else if (!c.isSpace()) {
            take_sign(i, c, ends_word);
        }
    }
    void take_sign(int i, QChar c, bool ends_word) {
        const bool began = std::exchange(begins_, false);
        if (began && (c == '"' || c == '\'')) {
            quote_ = c;
        } else if (began && (c == '[' || c == '{')) {
            open_.emplace_back(c, i + 1);
            begins_ = true;
        } else if (!open_.empty() && (c == ']' || c == '}')) {
            open_.pop_back();
        } else if (!open_.empty() && c == ',') {
            open_.back().second = i + 1;
            begins_ = true;
        } else {
            begins_ = ends_word && (c == ':' || (c == '-' && began));
        }
    }

    const QString& text_;
    int at_;
    std::vector<std::pair<QChar, int>> open_;  // open brackets, and where their items begin
    QChar quote_;
    int line_ = 0;
    bool comment_ = false;
    bool begins_ = true;  // a value or a key may begin here, in quotes or brackets
};

/// The words that the file readers list as valid in place of kNoWord in a text.
std::vector<Choice> words_in(const std::string& file, const QString& text) {
    const Unsaved unsaved(file, text.toStdString());
    Diagnostics diagnostics;
    session::check_file(file, diagnostics);
    for (const Problem& problem : diagnostics.problems()) {
        const auto names = [&](const char* quote) {
            return problem.what.find(quote + std::string(kNoWord) + quote) != std::string::npos;
        };
        const bool here = problem.key == kNoWord || names("'") || names("\"");
        if (here && !problem.choices.empty()) return problem.choices;
    }
    return {};
}

}  // namespace

WordPlace word_place(const QString& text, int cursor) {
    int start = cursor, end = cursor;
    while (start > 0 && is_letter(text[start - 1])) --start;
    while (end < text.size() && is_letter(text[end])) ++end;
    WordPlace out;
    out.typed = text.mid(start, cursor - start);
    out.has_colon = end < text.size() && text[end] == ':';
    const Around around = AroundFinder(text, start).find();
    out.is_key = around.takes_key();
    const auto with = [&](const QString& word) { return text.left(start) + word + text.mid(end); };
    const bool alone = out.is_key && !out.has_colon;
    const QString word = alone ? QString(kNoWord) + ": 0" : kNoWord;
    out.asking = with(word);
    if (alone && around.takes_item()) out.otherwise.emplace_back(with(kNoWord), false);
    const bool ends_line = text.mid(end, text.indexOf('\n', end) - end).trimmed().isEmpty();
    if (ends_line && !around.close.isEmpty())
        out.otherwise.emplace_back(with(word + around.close), out.is_key);
    return out;
}

WordFinder::~WordFinder() {
    pool_.waitForDone();
}

void WordFinder::find(const QString& file, const WordPlace& place) {
    const int number = ++asked_;
    pool_.start([this, number, name = file.toStdString(), place] {
        WordPlace where = place;
        std::vector<Choice> words = words_in(name, place.asking);
        for (const auto& [text, is_key] : place.otherwise) {
            if (!words.empty()) break;
            words = words_in(name, text);
            where.is_key = is_key;
        }
        QMetaObject::invokeMethod(this, [this, number, where, words = std::move(words)] {
            if (number == asked_) Q_EMIT found(where, words);
        });
    });
}

}  // namespace dihaptic::gui
