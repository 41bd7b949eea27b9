#include "sessions_dialog.h"

#include <QDialogButtonBox>
#include <QDir>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "recording/session.h"

namespace dihaptic::gui {

SessionsDialog::SessionsDialog(const QString& folder, QWidget* parent)
    : QDialog(parent), list_(new QTreeWidget) {
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Recorded sessions"));
    list_->setAccessibleName(tr("Sessions"));
    list_->setRootIsDecorated(false);
    list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
    list_->setHeaderLabels({tr("started"), tr("title"), tr("participant"), tr("moved by"),
                            tr("state"), tr("ticks"), tr("folder")});
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Open | QDialogButtonBox::Close);
    auto* layout = new QVBoxLayout(this);
    auto* where =
        new QLabel(tr("Sessions in %1. Two that are chosen (Ctrl + click) are shown side by side.")
                       .arg(QDir(folder).absolutePath()));
    where->setWordWrap(true);
    layout->addWidget(where);
    layout->addWidget(list_, 1);
    layout->addWidget(buttons);
    fill(folder);
    buttons->button(QDialogButtonBox::Open)->setEnabled(list_->topLevelItemCount() > 0);
    connect(buttons, &QDialogButtonBox::accepted, this, &SessionsDialog::choose);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(list_, &QTreeWidget::itemActivated, this, &SessionsDialog::choose);
    resize(900, 480);
}

void SessionsDialog::fill(const QString& folder) {
    const QFileInfoList all =
        QDir(folder).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name | QDir::Reversed);
    for (const QFileInfo& entry : all) {
        const QString path = entry.filePath();
        recording::SessionInfo info;
        QString state = tr("cannot be read");
        try {
            info = recording::SessionFolder::open(path.toStdString()).read_info();
            state = QString::fromLatin1(enum_name(info.state).data());
        } catch (const Error&) {
            if (!QFileInfo::exists(path + "/raw.log")) continue;  // no session
        }
        auto* item = new QTreeWidgetItem(
            list_, {QString::fromStdString(info.started).left(16).replace('T', ' '),
                    QString::fromStdString(info.title), QString::fromStdString(info.participant.id),
                    QString::fromStdString(info.moved_by.name()), state,
                    info.ticks > 0 ? QString::number(info.ticks) : "", entry.fileName()});
        item->setData(0, Qt::UserRole, path);
    }
    for (int column = 0; column < list_->columnCount(); ++column)
        list_->resizeColumnToContents(column);
    list_->setCurrentItem(list_->topLevelItem(0));
}

void SessionsDialog::choose() {
    QStringList folders;
    for (const QTreeWidgetItem* item : list_->selectedItems())
        folders += item->data(0, Qt::UserRole).toString();
    if (folders.isEmpty()) return;
    Q_EMIT chosen(folders);
    accept();
}

}  // namespace dihaptic::gui
