// Finds the words that are possible at a position in a file's text: keys, names, and names that the
// file itself defines. The candidates come from the file readers, whose error for an unknown word
// lists all valid ones.
#pragma once

#include <QObject>
#include <QString>
#include <QThreadPool>
#include <utility>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::gui {

/// A position in a text at which a word is being typed.
struct WordPlace {
    QString typed;           ///< typed part of the word, up to the cursor
    bool is_key = false;     ///< whether it is a key, not the word after a key
    bool has_colon = false;  ///< whether a colon follows the key
    QString asking;          ///< the text with the unknown placeholder word at this position
    /// A second text to try if the readers find nothing, and whether the word is a key in it: it
    /// may be an item of a list, or in brackets that are not closed yet.
    std::vector<std::pair<QString, bool>> otherwise;
};
/// The position of a cursor, in characters from the text's start.
WordPlace word_place(const QString& text, int cursor);

/// The placeholder word in the texts that are tried.
constexpr const char* kNoWord = "zz_no_word";

class WordFinder : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~WordFinder() override;

    /// Looks for words in a separate thread; `file`: the file of the text. Only the last request is
    /// answered.
    void find(const QString& file, const WordPlace& place);
    /// Cancels the last request.
    void forget() { ++asked_; }

  Q_SIGNALS:
    void found(const dihaptic::gui::WordPlace& place, const std::vector<dihaptic::Choice>& words);

  private:
    QThreadPool pool_;
    int asked_ = 0;
};

}  // namespace dihaptic::gui
