#include "word_finder.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>

#include "session/check.h"

namespace dihaptic::gui {
namespace {

bool is_letter(QChar c) {
    return c.isLetterOrNumber() || c == '_';
}

/// What the readers know where a text has kNoWord.
std::vector<Choice> words_in(const QString& file, const QString& text) {
    QFile out(file);
    if (!out.open(QIODevice::WriteOnly)) return {};
    out.write(text.toUtf8());
    out.close();
    Diagnostics diagnostics;
    // of half a text, on a full disk, there is nothing to tell
    if (out.error() == QFileDevice::NoError) session::check_file(file.toStdString(), diagnostics);
    QFile::remove(file);
    for (const Problem& problem : diagnostics.problems()) {
        const bool here = problem.key == kNoWord ||
                          problem.what.find(std::string("'") + kNoWord + "'") != std::string::npos;
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
    const int line = static_cast<int>(text.lastIndexOf('\n', start - 1)) + 1;
    const QString before = text.mid(line, start - line);
    static const QRegularExpression after_key(R"(:\s+$)");
    out.is_key = !before.contains(after_key);
    out.has_colon = end < text.size() && text[end] == ':';
    QString word = kNoWord;
    if (out.is_key && !out.has_colon) word += ": 0";
    out.asking = text.left(start) + word + text.mid(end);
    return out;
}

WordFinder::~WordFinder() {
    pool_.waitForDone();
}

void WordFinder::find(const QString& file, const WordPlace& place) {
    const QFileInfo info(file);
    const int number = ++asked_;
    const QString beside =
        info.dir().filePath(QString(".%1.words-%2.yaml").arg(info.completeBaseName()).arg(number));
    pool_.start([this, number, beside, place] {
        std::vector<Choice> words = words_in(beside, place.asking);
        QMetaObject::invokeMethod(this, [this, number, place, words = std::move(words)] {
            if (number == asked_) Q_EMIT found(place, words);
        });
    });
}

}  // namespace dihaptic::gui
