// A page that a task shows instead of the scene: Markdown text with a picture above it, which moves
// if the file is animated.
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

    /// Sets the page and returns whether it changed. `picture`: path of a file; empty if there is
    /// no picture. If both arguments are empty, there is no page.
    bool set_page(const QString& text, const QString& picture);
    /// Calls `moved` whenever an animated picture has changed.
    void on_move(std::function<void()> moved) { moved_ = std::move(moved); }

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void fit();
    void show_picture(const QString& file);

    QString text_;
    QString file_;
    QPixmap whole_;
    std::unique_ptr<QMovie> movie_;  ///< null if the picture is not animated
    std::function<void()> moved_;
    QLabel* picture_;
    QLabel* words_;
};

}  // namespace dihaptic::gui
