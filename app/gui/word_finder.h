// Finds the words that may stand at a place of a file's text: keys, names, and what the file itself
// gives a name. The readers of files know them: what they say of a word that is none has all that
// are.
#pragma once

#include <QObject>
#include <QString>
#include <QThreadPool>
#include <utility>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::gui {

/// A place of a text at which a word is being typed.
struct WordPlace {
    QString typed;           ///< of the word, up to the cursor
    bool is_key = false;     ///< otherwise, what stands after a key
    bool has_colon = false;  ///< of a key, behind it
    QString asking;          ///< the text with a word in its place that no file knows
    /// What else to ask if the readers know nothing then, and whether the word is a key in it: it
    /// may be an item of a list, or in brackets that are not closed yet.
    std::vector<std::pair<QString, bool>> otherwise;
};
/// The place where a cursor is, in characters from the text's start.
WordPlace word_place(const QString& text, int cursor);

/// The word that asking texts have.
constexpr const char* kNoWord = "zz_no_word";

class WordFinder : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~WordFinder() override;

    /// Looks for words in a thread of its own; `file`: that the text is of. Only what was asked
    /// last is answered.
    void find(const QString& file, const WordPlace& place);
    /// What was asked is not to be answered.
    void forget() { ++asked_; }

  Q_SIGNALS:
    void found(const dihaptic::gui::WordPlace& place, const std::vector<dihaptic::Choice>& words);

  private:
    QThreadPool pool_;
    int asked_ = 0;
};

}  // namespace dihaptic::gui
