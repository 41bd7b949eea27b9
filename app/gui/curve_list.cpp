#include "curve_list.h"

#include <QHeaderView>
#include <QLabel>
#include <QVBoxLayout>

#include "drawable.h"

namespace dihaptic::gui {
namespace {

constexpr int kNames = 170;  // width of the names [px]

}  // namespace

CurveList::CurveList(const scene::Scene& scene, QWidget* parent)
    : QWidget(parent), words_(new QLineEdit), list_(new QTreeWidget), curves_(new QLineEdit) {
    words_->setPlaceholderText(tr("Search quantities"));
    words_->setAccessibleName(tr("Search quantities"));
    words_->setClearButtonEnabled(true);
    list_->setAccessibleName(tr("Quantities"));
    list_->setRootIsDecorated(false);
    list_->setHeaderLabels({tr("curve"), tr("meaning")});
    for (const Choice& choice : drawable_quantities(scene)) {
        auto* item = new QTreeWidgetItem(
            list_, {QString::fromStdString(choice.word), QString::fromStdString(choice.what)});
        item->setCheckState(0, Qt::Unchecked);
        for (const int column : {0, 1}) item->setToolTip(column, item->text(1));
    }
    list_->setColumnWidth(0, kNames);
    curves_->setAccessibleName(tr("Curves"));
    curves_->setToolTip(
        tr("All curves that are drawn, separated by semicolons. They may be expressions: "
           "block.z - 20 mm; distance(thumb, index)"));
    auto* about = new QLabel;  // the list may be too narrow for a whole sentence
    about->setWordWrap(true);
    connect(list_, &QTreeWidget::currentItemChanged, about, [about](const QTreeWidgetItem* item) {
        about->setText(item == nullptr ? QString() : item->text(0) + ": " + item->text(1));
    });
    auto* label = new QLabel(tr("&Drawn, or an expression:"));
    label->setBuddy(curves_);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(words_);
    layout->addWidget(list_, 1);
    layout->addWidget(about);
    layout->addWidget(label);
    layout->addWidget(curves_);
    connect(words_, &QLineEdit::textChanged, this, &CurveList::search);
    connect(list_, &QTreeWidget::itemChanged, this,
            [this](const QTreeWidgetItem* item) { take_tick(*item); });
    connect(curves_, &QLineEdit::returnPressed, this, [this] { Q_EMIT chosen(typed()); });
}

QStringList CurveList::typed() const {
    QStringList out;
    for (const QString& text : curves_->text().split(';', Qt::SkipEmptyParts))
        out += text.trimmed();
    return out;
}

void CurveList::set_curves(const QStringList& expressions) {
    curves_->setText(expressions.join("; "));
    const QSignalBlocker quiet(list_);
    for (int i = 0; i < list_->topLevelItemCount(); ++i) {
        QTreeWidgetItem& item = *list_->topLevelItem(i);
        item.setCheckState(0, expressions.contains(item.text(0)) ? Qt::Checked : Qt::Unchecked);
    }
}

void CurveList::take_tick(const QTreeWidgetItem& item) {
    QStringList curves = typed();
    curves.removeAll(item.text(0));
    if (item.checkState(0) == Qt::Checked) curves += item.text(0);
    Q_EMIT chosen(curves);
}

void CurveList::search(const QString& words) {
    for (int i = 0; i < list_->topLevelItemCount(); ++i) {
        QTreeWidgetItem& item = *list_->topLevelItem(i);
        const QString text = item.text(0) + " " + item.text(1);
        item.setHidden(!text.contains(words.trimmed(), Qt::CaseInsensitive));
    }
}

}  // namespace dihaptic::gui
