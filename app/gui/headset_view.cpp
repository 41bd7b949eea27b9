#include "headset_view.h"

#include <QImage>

#include "label_fit.h"

namespace dihaptic::gui {
namespace {

constexpr int kRefresh = 16;  // time between checks for headset events [ms]
using headset::Words;

}  // namespace

HeadsetView::HeadsetView(const display::Headset& place)
    : place_(place), page_(new PageView(&words_)), banner_(new QLabel(&words_)), headset_(place) {
    words_.setAttribute(Qt::WA_TranslucentBackground);
    words_.resize(Words::kWidth, Words::kHeight);
    page_->setGeometry(words_.rect());
    page_->on_move([this] { draw_words(); });
    banner_->setStyleSheet(
        "background: rgba(20, 24, 30, 200); color: white; padding: 16px 28px; font-size: 44px; "
        "border-radius: 12px;");
    banner_->setAlignment(Qt::AlignCenter);
    banner_->hide();
    connect(&timer_, &QTimer::timeout, this, &HeadsetView::tend);
    timer_.start(kRefresh);
}

bool HeadsetView::is_at(const display::Headset& place) const {
    return place_.space == place.space && place_.position == place.position &&
           place_.rotation == place.rotation;
}

void HeadsetView::set_scene(const scene::Scene& scene, const frame::Frame& frame) {
    headset_.show(scene, frames_from(frame));
}

void HeadsetView::follow(const scene::Scene& scene,
                         std::shared_ptr<headset::Headset::Frames> frames) {
    headset_.show(scene, std::move(frames));
}

std::shared_ptr<headset::Headset::Frames> HeadsetView::frames_from(const frame::Frame& frame) {
    frame::Frame of_no_tick = frame;
    of_no_tick.sequence = -1;
    return std::make_shared<headset::Headset::Frames>(of_no_tick);
}

void HeadsetView::set_banner(const QString& text) {
    if (banner_->text() == text) return;
    banner_->setText(text);
    banner_->setVisible(!text.isEmpty());
    constexpr int kMargin = 40;
    fit_label(*banner_, Words::kWidth - kMargin);
    // above the hands, which are in the middle of the field of view
    banner_->move((Words::kWidth - banner_->width()) / 2, kMargin);
    draw_words();
}

void HeadsetView::set_page(const QString& text, const QString& picture) {
    if (page_->set_page(text, picture)) draw_words();
}

void HeadsetView::draw_words() {
    Words words;
    if (!page_->isHidden() || !banner_->isHidden()) {
        QImage picture(words_.size(), QImage::Format_ARGB32_Premultiplied);
        picture.fill(Qt::transparent);
        words_.render(&picture, {}, {}, QWidget::DrawChildren);
        const QImage plain = picture.convertToFormat(QImage::Format_RGBA8888);
        words.rgba.assign(plain.constBits(), plain.constBits() + plain.sizeInBytes());
    }
    headset_.set_words(std::move(words));
}

void HeadsetView::tend() {
    for (const headset::Showing& showing : headset_.take_showings()) Q_EMIT shown(showing);
    const bool over = headset_.ended();  // checked before the last messages are taken
    for (const headset::Note& note : headset_.take_notes())
        Q_EMIT told(QString::fromStdString(note.text), note.problem);
    if (!over) return;
    timer_.stop();
    Q_EMIT ended();
}

}  // namespace dihaptic::gui
