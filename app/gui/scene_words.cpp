#include "scene_words.h"

#include <algorithm>
#include <array>

#include "label_fit.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

SceneWords::SceneWords(QWidget& scene)
    : scene_(scene),
      page_(new PageView(&scene)),
      questions_(new QuestionsView(&scene)),
      banner_(new SignLabel(&scene)),
      held_(new SignLabel(&scene)),
      help_(new QLabel(&scene)) {
    held_->set(QObject::tr("Hand held"),
               QObject::tr("It does not follow the mouse. H moves it again."), Sign::paused);
    help_->setAttribute(Qt::WA_TransparentForMouseEvents);
    help_->hide();
    help_->setStyleSheet(
        "background: rgba(255, 255, 255, 190); color: #20242a; padding: 8px 12px; border-radius: "
        "6px;");
}

void SceneWords::set_banner(const QString& word, const QString& text, std::optional<Sign> sign) {
    if (!banner_->set(word, text, sign)) return;
    show_banner();
    place();
}

void SceneWords::ask(const std::optional<Asked>& asked) {
    questions_->ask(asked);
    show_banner();
}

/// Shows the banner, unless a form is shown, which contains all its texts itself.
void SceneWords::show_banner() {
    banner_->setVisible(!banner_->is_empty() && !questions_->shows_form());
}

void SceneWords::set_held(bool held) {
    is_held_ = held;
    show_help();
}

void SceneWords::set_help(const QString& text) {
    if (help_->text() == text) return;
    help_->setText(text);
    show_help();
    place();
}

void SceneWords::show_help() {
    held_->setVisible(is_held_ && !help_->text().isEmpty());
    help_->setVisible(!is_held_ && !help_->text().isEmpty());
}

void SceneWords::set_display(const std::optional<display::Display>& display) {
    display_ = display;
    const bool turned = display && display->mirrored != display::Mirrored::no;
    const bool split = display && (display->stereo == display::Stereo::side_by_side ||
                                   display->stereo == display::Stereo::top_bottom);
    std::unique_ptr<QWidget> canvas;
    if (turned || split) {
        canvas = std::make_unique<QWidget>();
        canvas->setAttribute(Qt::WA_TranslucentBackground);
    }
    QWidget* const parent = canvas ? canvas.get() : &scene_;
    for (QWidget* child : std::array<QWidget*, 5>{page_, questions_, banner_, held_, help_}) {
        const bool hidden = child->isHidden();
        child->setParent(parent);
        child->setVisible(!hidden);
    }
    canvas_ = std::move(canvas);
    place();
}

void SceneWords::place() {
    QSize room = scene_.size();
    if (canvas_) {
        const view::Pane pane = view::panes(*display_, 1).front();
        room = {static_cast<int>(room.width() * pane.width),
                static_cast<int>(room.height() * pane.height)};
        canvas_->resize(room);
    }
    const int width = room.width(), height = room.height();
    page_->setGeometry({{0, 0}, room});
    questions_->place(room);
    // legible from a chair on a screen of any size
    const int letter = std::max(20, height / 30);
    for (SignLabel* label : {banner_, held_}) label->fit(letter, width - 40);
    fit_label(*help_, width - 24);
    banner_->move((width - banner_->width()) / 2, 24);
    held_->move((width - held_->width()) / 2, height - held_->height() - 24);
    help_->move(12, height - help_->height() - 12);
}

void SceneWords::draw(QPainter& painter) const {
    const QList<QWidget*> children = canvas_->findChildren<QWidget*>(Qt::FindDirectChildrenOnly);
    if (std::all_of(children.begin(), children.end(), [](QWidget* w) { return w->isHidden(); }))
        return;
    const double scale = scene_.devicePixelRatioF();
    QImage picture(canvas_->size() * scale, QImage::Format_ARGB32_Premultiplied);
    picture.setDevicePixelRatio(scale);
    picture.fill(Qt::transparent);
    canvas_->render(&picture, {}, {}, QWidget::DrawChildren);
    picture = picture.mirrored(display_->mirrored == display::Mirrored::left_right,
                               display_->mirrored == display::Mirrored::up_down);
    for (const view::Pane& pane : view::panes(*display_, 1)) {
        painter.drawImage(
            QPointF(pane.left * scene_.width(), (1 - pane.bottom - pane.height) * scene_.height()),
            picture);
        if (!pane.green_blue) break;  // both eyes see the whole picture
    }
}

}  // namespace dihaptic::gui
