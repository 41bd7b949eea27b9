// Finds the words that are possible at a position in a file's text: keys, fixed names, and names
// that the file itself defines. The candidates come from the file readers: their error message for
// an unknown word lists all valid words.
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
    QString typed;           ///< part of the word that has been typed, up to the cursor
    bool is_key = false;     ///< whether the word is a key, not the value of a key
    bool has_colon = false;  ///< whether a colon follows the key
    QString asking;          ///< the text with a placeholder, valid nowhere, at this position
    /// Further texts to try if the readers find nothing, each with whether the word is a key in it:
    /// the word may be an item of a list, or in brackets that are not closed yet.
    std::vector<std::pair<QString, bool>> otherwise;
};
/// Describes the position of a cursor, given in characters from the start of the text.
WordPlace word_place(const QString& text, int cursor);

/// The placeholder word in the texts that are tried.
constexpr const char* kNoWord = "zz_no_word";

class WordFinder : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~WordFinder() override;

    /// Looks for words in a separate thread. `file`: the file that contains the text. Only the
    /// latest request is answered.
    void find(const QString& file, const WordPlace& place);
    /// Cancels the latest request.
    void forget() { ++asked_; }

  Q_SIGNALS:
    void found(const dihaptic::gui::WordPlace& place, const std::vector<dihaptic::Choice>& words);

  private:
    QThreadPool pool_;
    int asked_ = 0;
};

}  // namespace dihaptic::gui
