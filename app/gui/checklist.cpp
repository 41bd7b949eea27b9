#include "checklist.h"

#include <QApplication>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <algorithm>

#include "icons.h"
#include "theme.h"

namespace dihaptic::gui {
namespace {

QString name_of(session::Remedy remedy) {
    switch (remedy) {
        case session::Remedy::calibrate:
            return QObject::tr("&Calibrate ...");
        case session::Remedy::register_display:
            return QObject::tr("Re&gister ...");
        case session::Remedy::choose_folder:
            return QObject::tr("Another &folder ...");
        case session::Remedy::allow_real_time:
            return QObject::tr("What this &means");
        case session::Remedy::none:
            break;
    }
    return "";
}

/// A sign in words and as a shape: good, to be checked, or merely worth knowing.
QLabel* mark_of(const session::Finding& finding) {
    const bool note = finding.good && !finding.how.empty();
    auto* mark = new QLabel;
    mark->setAccessibleName(note           ? QObject::tr("note")
                            : finding.good ? QObject::tr("good")
                                           : QObject::tr("to be checked"));
    mark->setToolTip(mark->accessibleName());
    const QColor colour = note           ? QApplication::palette().color(QPalette::WindowText)
                          : finding.good ? tone(Tone::good)
                                         : tone(Tone::bad);
    const auto shape = note ? shapes::kNote : finding.good ? shapes::kReady : shapes::kFault;
    mark->setPixmap(
        icon_picture(shape, colour, mark->fontMetrics().height(), mark->devicePixelRatioF()));
    return mark;
}

}  // namespace

ChecksView::ChecksView(QWidget* parent) : QWidget(parent), rows_(new QVBoxLayout(this)) {
    rows_->setSpacing(space::kUsual);
}

void ChecksView::set(const std::vector<session::Finding>& findings) {
    while (QLayoutItem* item = rows_->takeAt(0)) {
        if (QWidget* row = item->widget()) {
            row->hide();
            row->deleteLater();  // its button may be what leads here
        }
        delete item;
    }
    for (const session::Finding& finding : findings) add(finding);
    rows_->addStretch(1);
}

void ChecksView::add(const session::Finding& finding) {
    auto* row = new QWidget;
    auto* grid = new QGridLayout(row);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setColumnStretch(1, 1);
    auto* what = new QLabel(QString::fromStdString(finding.what));
    what->setFont(sized(font(), 1, true));
    auto* text = new QLabel(
        QString::fromStdString(finding.found + (finding.how.empty() ? "." : ". " + finding.how)));
    text->setWordWrap(true);
    text->setTextInteractionFlags(Qt::TextSelectableByMouse);
    grid->addWidget(mark_of(finding), 0, 0);
    grid->addWidget(what, 0, 1);
    grid->addWidget(text, 1, 1, 1, 2);
    rows_->addWidget(row);
    // what needs nothing offers nothing; the menus do so at any time
    if (finding.remedy == session::Remedy::none || (finding.good && finding.how.empty())) return;
    auto* button = new QPushButton(name_of(finding.remedy));
    button->setAutoDefault(false);
    grid->addWidget(button, 0, 2);
    connect(button, &QPushButton::clicked, this,
            [this, remedy = finding.remedy] { Q_EMIT chosen(remedy); });
}

Checklist::Checklist(const std::vector<session::Finding>& findings, bool before_start,
                     QWidget* parent)
    : QDialog(parent) {
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Before the session"));
    auto* checks = new ChecksView;
    checks->set(findings);
    connect(checks, &ChecksView::chosen, this, [this](session::Remedy remedy) {
        reject();
        Q_EMIT chosen(remedy);
    });
    auto* buttons = new QDialogButtonBox;
    if (before_start) {
        const bool good = std::all_of(findings.begin(), findings.end(),
                                      [](const session::Finding& f) { return f.good; });
        QPushButton* start = buttons->addButton(good ? tr("&Start") : tr("&Start anyway"),
                                                QDialogButtonBox::AcceptRole);
        start->setDefault(true);
        buttons->addButton(QDialogButtonBox::Cancel)->setAutoDefault(false);
    } else {
        buttons->addButton(QDialogButtonBox::Close);
    }
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(checks, 1);
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    resize(560, sizeHint().height());
}

}  // namespace dihaptic::gui
