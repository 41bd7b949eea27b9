#include "note_dialog.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QVBoxLayout>

#include "plain_text.h"

namespace dihaptic::gui {

std::optional<QString> ask_for_note(const QString& session, const QString& before,
                                    QWidget* parent) {
    QDialog ask(parent);
    ask.setWindowTitle(QObject::tr("Note"));
    auto* label = new QLabel(QObject::tr("Note about %1").arg(session));
    auto* edit = new PlainText;
    edit->setPlainText(before);
    edit->setTabChangesFocus(true);
    label->setBuddy(edit);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    auto* layout = new QVBoxLayout(&ask);
    layout->addWidget(label);
    layout->addWidget(edit);
    layout->addWidget(buttons);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &ask, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &ask, &QDialog::reject);
    edit->setFocus();
    if (ask.exec() != QDialog::Accepted) return {};
    return clean_text(edit->toPlainText());
}

}  // namespace dihaptic::gui
