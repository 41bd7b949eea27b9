// The panel in which the user chooses the curves that the player of a session draws.
#pragma once

#include <QLineEdit>
#include <QTreeWidget>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::gui {

class CurveList : public QWidget {
    Q_OBJECT

  public:
    /// `scene`: the scene of the session, whose fingers, bodies and joints have quantities.
    explicit CurveList(const scene::Scene& scene, QWidget* parent = nullptr);

    /// Marks these curves as those that are drawn.
    void set_curves(const QStringList& expressions);
    /// Moves the keyboard focus to the field for words to search.
    void find() { words_->setFocus(Qt::ShortcutFocusReason); }

  Q_SIGNALS:
    /// The user chose these expressions.
    void chosen(const QStringList& expressions);

  private:
    void search(const QString& words);
    void take_tick(const QTreeWidgetItem& item);
    QStringList typed() const;

    QLineEdit* words_;
    QTreeWidget* list_;
    QLineEdit* curves_;
};

}  // namespace dihaptic::gui
