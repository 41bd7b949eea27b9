#include "checklist.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

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

}  // namespace

Checklist::Checklist(const std::vector<session::Finding>& findings, bool before_start,
                     QWidget* parent)
    : QDialog(parent) {
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Before the session"));
    auto* rows = new QGridLayout;
    rows->setColumnStretch(2, 1);
    for (const session::Finding& finding : findings) add(*rows, finding);
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
    layout->addLayout(rows);
    layout->addStretch(1);
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    resize(680, sizeHint().height());
}

void Checklist::add(QGridLayout& rows, const session::Finding& finding) {
    const int row = rows.rowCount();
    auto* mark = new QLabel(finding.good ? "\u2713" : "!");
    mark->setAccessibleName(finding.good ? tr("good") : tr("to be checked"));
    mark->setStyleSheet(finding.good ? "color: #009e73; font-weight: bold"
                                     : "color: #d55e00; font-weight: bold");
    auto* text = new QLabel(
        QString::fromStdString(finding.found + (finding.how.empty() ? "." : ". " + finding.how)));
    text->setWordWrap(true);
    text->setTextInteractionFlags(Qt::TextSelectableByMouse);
    rows.addWidget(mark, row, 0, Qt::AlignTop);
    rows.addWidget(new QLabel(QString::fromStdString(finding.what)), row, 1, Qt::AlignTop);
    rows.addWidget(text, row, 2);
    if (finding.remedy == session::Remedy::none) return;
    auto* button = new QPushButton(name_of(finding.remedy));
    button->setAutoDefault(false);
    rows.addWidget(button, row, 3, Qt::AlignTop);
    connect(button, &QPushButton::clicked, this, [this, remedy = finding.remedy] {
        reject();
        Q_EMIT chosen(remedy);
    });
}

}  // namespace dihaptic::gui
