#include "sign_label.h"

#include "icons.h"
#include "label_fit.h"

namespace dihaptic::gui {

SignLabel::SignLabel(QWidget* parent) : QLabel(parent), icon_(new QLabel(this)) {
    setAttribute(Qt::WA_TransparentForMouseEvents);
    icon_->hide();
    hide();
}

bool SignLabel::set(const QString& word, const QString& text, std::optional<Sign> sign) {
    QString lines = text.toHtmlEscaped();
    // long names of folders and files may be broken there
    lines.replace('_', QStringLiteral("_\u200b")).replace('/', QStringLiteral("/\u200b"));
    lines.replace('\n', "<br>");
    const QString all =
        word.isEmpty()
            ? text
            : QString("<b style='font-size: large'>%1</b><br>%2").arg(word.toHtmlEscaped(), lines);
    if (sign == sign_ && all == this->text()) return false;
    sign_ = sign;
    icon_->setVisible(sign.has_value());
    setTextFormat(word.isEmpty() ? Qt::PlainText : Qt::RichText);
    setText(all);
    return true;
}

void SignLabel::set_letter(int letter) {
    letter_ = letter;
    const QColor fill = sign_ ? look_of(*sign_).fill : QColor(20, 24, 30, 200);
    const QColor ink = sign_ ? look_of(*sign_).ink : QColor(Qt::white);
    setStyleSheet(QString("background: rgba(%1, %2, %3, %4); color: %5; font-size: %6px; "
                          "padding: 12px 20px 12px %7px; border-radius: 8px;")
                      .arg(fill.red())
                      .arg(fill.green())
                      .arg(fill.blue())
                      .arg(fill.alpha())
                      .arg(ink.name())
                      .arg(letter)
                      .arg(sign_ ? letter * 3 / 2 + 2 * space::kWide : 20));
    if (!sign_) return;
    icon_->setStyleSheet("background: none; padding: 0;");
    icon_->setPixmap(icon_picture(look_of(*sign_).icon, ink, letter * 3 / 2, devicePixelRatioF()));
    place_icon();
}

void SignLabel::fit(int letter, int widest) {
    set_letter(letter);
    fit_label(*this, widest);
}

void SignLabel::resizeEvent(QResizeEvent* event) {
    QLabel::resizeEvent(event);
    place_icon();
}

void SignLabel::place_icon() {
    const int size = letter_ * 3 / 2;
    icon_->setGeometry(space::kWide, (height() - size) / 2, size, size);
}

}  // namespace dihaptic::gui
