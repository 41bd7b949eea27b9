#include "page_view.h"

#include <QVBoxLayout>
#include <algorithm>

namespace dihaptic::gui {

PageView::PageView(QWidget* parent)
    : QWidget(parent), picture_(new QLabel(this)), words_(new QLabel(this)) {
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_StyledBackground);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(40, 40, 40, 40);
    layout->addStretch();
    for (QLabel* label : {picture_, words_}) {
        label->setAlignment(Qt::AlignCenter);
        layout->addWidget(label);
    }
    layout->addStretch();
    words_->setTextFormat(Qt::MarkdownText);
    words_->setWordWrap(true);
    hide();
}

bool PageView::set_page(const QString& text, const QString& picture) {
    if (text == text_ && picture == file_) return false;
    text_ = text;
    if (picture != file_) show_picture(picture);
    words_->setText(text_);
    words_->setVisible(!text_.isEmpty());
    setVisible(!text_.isEmpty() || !file_.isEmpty());
    fit();
    return true;
}

void PageView::show_picture(const QString& file) {
    file_ = file;
    movie_.reset();
    whole_ = file.isEmpty() ? QPixmap() : QPixmap(file);
    if (file.isEmpty()) return;
    auto movie = std::make_unique<QMovie>(file);
    if (movie->frameCount() < 2) return;
    movie_ = std::move(movie);
    connect(movie_.get(), &QMovie::frameChanged, this, [this] {
        whole_ = movie_->currentPixmap();
        fit();
        if (moved_) moved_();
    });
    movie_->start();
}

void PageView::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    fit();
}

/// Scales the picture and the letters to the page; letters must be legible from a chair.
void PageView::fit() {
    setStyleSheet(QString("background: #14181e; color: white; font-size: %1px;")
                      .arg(std::max(20, height() / 30)));
    picture_->setVisible(!whole_.isNull());
    if (whole_.isNull()) return;
    const QSize most(std::max(1, width() - 80), std::max(1, height() * 6 / 10));
    picture_->setPixmap(whole_.scaled(whole_.size().boundedTo(most), Qt::KeepAspectRatio,
                                      Qt::SmoothTransformation));
}

}  // namespace dihaptic::gui
