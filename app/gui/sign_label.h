// A label that is read from a distance: a text of the task, or a sign of the session with its
// colour, icon and word.
#pragma once

#include <QLabel>
#include <optional>

#include "theme.h"

namespace dihaptic::gui {

class SignLabel : public QLabel {
  public:
    explicit SignLabel(QWidget* parent);

    /// `word`: written above the text, in bold; "" for none. `sign`: nullopt for a text of the
    /// task. Returns whether this changes anything.
    bool set(const QString& word, const QString& text, std::optional<Sign> sign = std::nullopt);
    bool is_empty() const { return text().isEmpty(); }
    /// Sets the size of the letters [pixels].
    void set_letter(int letter);
    /// Fits the label to its text, in letters of `letter` pixels, at most `widest` pixels wide.
    void fit(int letter, int widest);

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void place_icon();

    std::optional<Sign> sign_;
    QLabel* icon_;
    int letter_ = 0;  ///< [pixels]
};

}  // namespace dihaptic::gui
