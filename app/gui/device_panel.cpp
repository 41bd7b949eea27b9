#include "device_panel.h"

#include <fmt/format.h>

#include <QHeaderView>
#include <QProgressBar>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

#include "theme.h"

namespace dihaptic::gui {
namespace {

struct DeviceColumn {
    enum { finger, force, bar, status, model, count };
};

constexpr int kStatus = 12;        // width of the column [characters]
constexpr int kLoadBar = 48;       // width of the column [pixels]
constexpr int kWidestTable = 400;  // the table takes no more room from the panel beside it [pixels]

/// `finger`: status of a finger's device; `all`: status of the frame, in which any device may have
/// switched force off.
QString words(uint32_t finger, uint32_t all) {
    if (finger != 0) return QString::fromStdString(dihaptic::words(finger));
    return (all & kForceOff) != 0 ? QObject::tr("force off") : QObject::tr("OK");
}

}  // namespace

DevicePanel::DevicePanel(QWidget* parent)
    : QWidget(parent), table_(new QTableWidget(0, DeviceColumn::count)), loop_(new QLabel) {
    table_->setHorizontalHeaderLabels(
        {tr("Finger"), tr("Force / limit"), tr("Load"), tr("Status"), tr("Device")});
    table_->horizontalHeaderItem(DeviceColumn::bar)
        ->setToolTip(tr("The force as a share of its limit"));
    table_->verticalHeader()->hide();
    table_->horizontalHeader()->setStretchLastSection(true);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + space::kUsual);
    table_->setSelectionMode(QAbstractItemView::NoSelection);
    loop_->setWordWrap(true);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(space::kTight, space::kTight, space::kTight, space::kTight);
    layout->addWidget(table_);
    layout->addWidget(loop_);
}

void DevicePanel::set_devices(const std::vector<Device>& devices) {
    devices_ = devices;
    overruns_ = unbalanced_ = missed_ = 0;
    lateness_ = tick_ = 0;
    loop_->clear();
    table_->setRowCount(static_cast<int>(devices.size()));
    for (int i = 0; i < table_->rowCount(); ++i) {
        const Device& device = devices[static_cast<size_t>(i)];
        table_->setItem(i, DeviceColumn::finger, new QTableWidgetItem(device.finger));
        table_->setItem(i, DeviceColumn::model, new QTableWidgetItem(device.model));
        table_->setItem(i, DeviceColumn::status, new QTableWidgetItem(tr("idle")));
        auto* bar = new QProgressBar;
        bar->setRange(0, 1000);
        bar->setTextVisible(false);  // the text would be cut by the end of the bar
        table_->setCellWidget(i, DeviceColumn::bar, bar);
        table_->setItem(i, DeviceColumn::force, new QTableWidgetItem);
        show_force(i, 0);
    }
    table_->resizeColumnsToContents();
    // wide enough for what the columns will show, and for their headings
    const auto widen = [this](int column, int width) {
        table_->setColumnWidth(column, std::max(table_->columnWidth(column), width));
    };
    widen(DeviceColumn::status, kStatus * fontMetrics().averageCharWidth());
    widen(DeviceColumn::force,
          fontMetrics().horizontalAdvance("00.00 / 00.0 N") + 2 * space::kUsual);
    table_->setColumnWidth(
        DeviceColumn::bar,
        std::max(kLoadBar, table_->horizontalHeader()->sectionSizeHint(DeviceColumn::bar)));
    // the last column is stretched, so that its own width says nothing
    int width = 2 * table_->frameWidth() +
                static_cast<QAbstractItemView*>(table_)->sizeHintForColumn(DeviceColumn::model);
    for (int i = 0; i < DeviceColumn::model; ++i) width += table_->columnWidth(i);
    width += space::kUsual;
    table_->horizontalHeader()->setStretchLastSection(width <= kWidestTable);
    if (width > kWidestTable) table_->resizeColumnToContents(DeviceColumn::model);
    table_->setMinimumWidth(std::min(width, kWidestTable));
}

void DevicePanel::show_force(int device, double force) {
    const double most = devices_[static_cast<size_t>(device)].most_force;
    const bool limited = std::isfinite(most);
    auto* bar = qobject_cast<QProgressBar*>(table_->cellWidget(device, DeviceColumn::bar));
    bar->setValue(limited ? static_cast<int>(1000 * std::min(1.0, force / most)) : 0);
    table_->item(device, DeviceColumn::force)
        ->setText(limited ? QString("%1 / %2 N").arg(force, 0, 'f', 2).arg(most, 0, 'f', 1)
                          : QString("%1 N").arg(force, 0, 'f', 2));
}

void DevicePanel::rest(const QString& why) {
    for (int i = 0; i < table_->rowCount(); ++i) {
        show_force(i, 0);
        table_->item(i, DeviceColumn::status)->setText(why);
        table_->item(i, DeviceColumn::status)->setToolTip(why);
    }
}

void DevicePanel::show_frame(const frame::Frame& frame) {
    for (size_t i = 0; i < devices_.size() && i < frame.fingers.size(); ++i) {
        const frame::FingerFrame& finger = frame.fingers[i];
        show_force(static_cast<int>(i), finger.f_sent_W.norm());
        QTableWidgetItem* status = table_->item(static_cast<int>(i), DeviceColumn::status);
        status->setText(words(finger.status, frame.status));
        status->setToolTip(status->text());  // the words of several faults are longer than a column
    }
    if (frame.status & kOverrun) ++overruns_;
    if (frame.status & kUnbalanced) ++unbalanced_;
    if (frame.status & kSolverMissed) ++missed_;
    // slow averages, because the figures of single ticks would flicker
    const auto follow = [](double& value, double now) {
        if (std::isfinite(now)) value += 0.05 * (now - value);
    };
    follow(lateness_, frame.lateness);
    follow(tick_, frame.tick_duration);
    loop_->setText(
        tr("Loop: tick %1 us, wake-up late by %2 us, overruns among the frames shown: %3. %4")
            .arg(tick_ * 1e6, 0, 'f', 0)
            .arg(lateness_ * 1e6, 0, 'f', 0)
            .arg(overruns_)
            .arg((frame.status & kForceOff) != 0 ? tr("Force is off.") : "") +
        (unbalanced_ > 0
             ? tr("\nEnergy or momentum unbalanced in %1 of the frames shown.").arg(unbalanced_)
             : QString()) +
        (missed_ > 0
             ? tr("\nContact solver missed its tolerance in %1 of the frames shown.").arg(missed_)
             : QString()));
    QStringList why;
    for (const auto& [seen, bit] :
         {std::pair{unbalanced_, kUnbalanced}, {missed_, kSolverMissed}}) {
        const StatusRow& row = describe(bit);
        if (seen > 0) why << QString::fromStdString(fmt::format("{}: {}", row.what, row.remedy));
    }
    loop_->setToolTip(why.join('\n'));
}

}  // namespace dihaptic::gui
