// A page that a task shows in place of the scene: text, in Markdown, and a picture above it, which
// moves if its file is animated.
#pragma once

#include <QLabel>
#include <QMovie>
#include <QPixmap>
#include <functional>
#include <memory>

namespace dihaptic::gui {

class PageView : public QWidget {
  public:
    explicit PageView(QWidget* parent);

    /// `picture`: a file, or empty. Without text and picture there is no page. Returns whether the
    /// page changed.
    bool set_page(const QString& text, const QString& picture);
    /// Calls `moved` whenever the picture has moved.
    void on_move(std::function<void()> moved) { moved_ = std::move(moved); }

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void fit();
    void show_picture(const QString& file);

    QString text_;
    QString file_;
    QPixmap whole_;
    std::unique_ptr<QMovie> movie_;  ///< null: the picture stands still
    std::function<void()> moved_;
    QLabel* picture_;
    QLabel* words_;
};

}  // namespace dihaptic::gui
