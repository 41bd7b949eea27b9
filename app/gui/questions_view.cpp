#include "questions_view.h"

#include <QGridLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

const QColor kSheet(20, 24, 30, 235);
constexpr double kSheetCorner = 8;  // [pixels]
/// From this number of items on, each item's line is placed next to its question, not below it.
constexpr size_t kMany = 9;

}  // namespace

QuestionsView::QuestionsView(QWidget* parent) : QWidget(parent), layout_(new QGridLayout(this)) {
    setAccessibleName(tr("Questions"));
    layout_->setSpacing(0);
    layout_->setColumnStretch(0, 2);
    layout_->setColumnStretch(1, 3);
    hide();
}

void QuestionsView::ask(const std::optional<Asked>& asked) {
    const bool same =
        asked ? asked->items.data() == first_ && asked->items.size() == count_ : first_ == nullptr;
    if (!same) fill(asked.value_or(Asked{}));
    if (!asked) return;
    for (size_t i = 0; i < rows_.size(); ++i) {
        rows_[i].line->set_answer(asked->answers[i], is_form_ && i == asked->now);
        if (!is_form_) continue;
        QFont font = rows_[i].question->font();
        font.setBold(i == asked->now);
        rows_[i].question->setFont(font);
        rows_[i].question->setText(text_of(*asked, i));
    }
    if (done_ != nullptr) done_->setEnabled(asked->now == count_);
}

QString QuestionsView::text_of(const Asked& asked, size_t item) {
    const QString question = QString::fromStdString(asked.items[item].question);
    const double answer = asked.answers[item];
    if (!std::isnan(answer)) return question + QString(":  %1").arg(answer);
    return item == asked.now && !asked.typed.isEmpty() ? question + ":  " + asked.typed : question;
}

void QuestionsView::fill(const Asked& asked) {
    rows_.clear();
    while (QLayoutItem* const item = layout_->takeAt(0)) {
        delete item->widget();
        delete item;
    }
    for (int row = 0; row < layout_->rowCount(); ++row) layout_->setRowStretch(row, 0);
    title_ = nullptr;
    done_ = nullptr;
    first_ = asked.items.data();
    count_ = asked.items.size();
    is_form_ = asked.is_form;
    if (is_form_) {
        title_ = new QLabel(asked.title, this);
        layout_->addWidget(title_, 0, 0, 1, 2);
    }
    for (size_t i = 0; i < count_; ++i) {
        const task::AskSpec& item = asked.items[i];
        QLabel* question = nullptr;
        if (is_form_) {
            question = new QLabel(QString::fromStdString(item.question), this);
            question->setWordWrap(true);
        }
        auto* const line = new RatingView(this);
        line->set_question(&item);
        line->setAccessibleName(QString::fromStdString(item.question));
        const int row = 1 + 2 * static_cast<int>(i);
        const bool beside = count_ >= kMany;
        if (question != nullptr) layout_->addWidget(question, row, 0, 1, beside ? 1 : 2);
        layout_->addWidget(line, beside ? row : row + 1, beside ? 1 : 0, 1, beside ? 1 : 2);
        layout_->setRowStretch(beside ? row : row + 1, 1);
        connect(line, &RatingView::clicked, this,
                [this, i](double share) { Q_EMIT clicked(task::Click::at(i, share)); });
        rows_.push_back({question, line});
    }
    if (is_form_) {
        done_ = new QPushButton(tr("Done (Enter)"), this);
        done_->setFocusPolicy(Qt::NoFocus);  // keys must remain available for answers
        layout_->addWidget(done_, 1 + 2 * static_cast<int>(count_), 0, 1, 2, Qt::AlignRight);
        connect(done_, &QPushButton::clicked, this,
                [this] { Q_EMIT clicked(task::Click::at(count_, 0)); });
    }
    setVisible(count_ > 0);
    fit();
}

void QuestionsView::place(const QSize& room) {
    room_ = room;
    fit();
}

/// Places the questions: a rating at the bottom of the scene, a form in place of the scene.
void QuestionsView::fit() {
    const int width = room_.width(), height = room_.height();
    if (is_form_) {
        // legible from a chair, if there is enough room for all items
        const int rows = static_cast<int>(count_) * (count_ >= kMany ? 2 : 4) + 6;
        const int letters = std::clamp(height / rows, 11, std::max(12, height / 30));
        setStyleSheet(QString("QLabel { color: white; font-size: %1px; } "
                              "QPushButton { font-size: %1px; padding: 4px 16px; }")
                          .arg(letters));
        if (title_ != nullptr)
            title_->setStyleSheet(
                QString("font-weight: bold; font-size: %1px;").arg(letters * 5 / 4));
        layout_->setContentsMargins(24, 12, 24, 12);
        setGeometry(width / 20, height / 20, width * 18 / 20, height * 18 / 20);
    } else {
        layout_->setContentsMargins(0, 0, 0, 0);
        setGeometry(width / 10, height * 7 / 10, width * 8 / 10, height * 2 / 10);
    }
}

void QuestionsView::paintEvent(QPaintEvent*) {
    if (!is_form_) return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(kSheet);
    painter.drawRoundedRect(rect(), kSheetCorner, kSheetCorner);
}

}  // namespace dihaptic::gui
