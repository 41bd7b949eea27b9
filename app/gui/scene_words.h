// What is written over a scene: a page, questions, the banner, and how the mouse moves the hand.
// The texts overlay the picture. If it is seen in a mirror, or split between the eyes, they are
// drawn into it instead.
#pragma once

#include <QLabel>
#include <QPainter>
#include <memory>

#include "display/display.h"
#include "page_view.h"
#include "questions_view.h"
#include "sign_label.h"

namespace dihaptic::gui {

class SceneWords {
  public:
    /// `scene` is the widget that shows the scene.
    explicit SceneWords(QWidget& scene);

    /// See the functions of SceneWidget with these names.
    void set_banner(const QString& word, const QString& text, std::optional<Sign> sign = {});
    void set_help(const QString& text);
    void set_page(const QString& text, const QString& picture) { page_->set_page(text, picture); }
    void ask(const std::optional<Asked>& asked);
    const QuestionsView& questions() const { return *questions_; }
    /// Sets whether the hand is held in place, which is said instead of the help.
    void set_held(bool held);

    /// Sets the display on which the scene is drawn; nullopt for a camera's view.
    void set_display(const std::optional<display::Display>& display);
    /// Places everything anew, to be called when the scene's size has changed.
    void place();
    /// Whether the texts must be drawn into the picture.
    bool in_picture() const { return canvas_ != nullptr; }
    /// Draws the texts into each eye's part of the picture, mirrored if it is seen in a mirror.
    void draw(QPainter& painter) const;

  private:
    void show_banner();
    void show_help();

    QWidget& scene_;
    std::optional<display::Display> display_;
    std::unique_ptr<QWidget> canvas_;  // holds the texts that are drawn into the picture
    bool is_held_ = false;
    PageView* page_;
    QuestionsView* questions_;
    SignLabel* banner_;
    SignLabel* held_;
    QLabel* help_;
};

}  // namespace dihaptic::gui
