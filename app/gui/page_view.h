// A page that a task shows in place of the scene: text, in Markdown, and a picture above it.
#pragma once

#include <QLabel>
#include <QPixmap>

namespace dihaptic::gui {

class PageView : public QWidget {
  public:
    explicit PageView(QWidget* parent);

    /// `picture`: a file, or empty. Without text and picture there is no page. Returns whether the
    /// page changed.
    bool set_page(const QString& text, const QString& picture);

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void fit();

    QString text_;
    QString file_;
    QPixmap whole_;
    QLabel* picture_;
    QLabel* words_;
};

}  // namespace dihaptic::gui
