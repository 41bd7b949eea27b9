#include "moment_list.h"

#include <QHeaderView>
#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

constexpr double kSame = 1e-6;        // times that differ by less are the same [s]
constexpr int kTime = Qt::UserRole;   // of the first column: the time [s]
constexpr int kTimes = Qt::UserRole;  // of the second column: how often it occurred

}  // namespace

MomentList::MomentList(QWidget* parent) : QTreeWidget(parent) {
    setAccessibleName(tr("Moments"));
    setRootIsDecorated(false);
    setHeaderLabels({tr("time [s]"), tr("what happens")});
    setFocusPolicy(Qt::ClickFocus);
    header()->resizeSection(0, 80);
    connect(this, &QTreeWidget::itemClicked, this, [this](const QTreeWidgetItem* item) {
        Q_EMIT chosen(item->data(0, kTime).toDouble());
    });
}

void MomentList::add(double seconds, const QString& what) {
    if (!std::isfinite(seconds)) return;
    auto* item = new QTreeWidgetItem(this, {QString("%1").arg(seconds, 8, 'f', 3), what});
    item->setTextAlignment(0, Qt::AlignRight | Qt::AlignVCenter);
    item->setData(0, kTime, seconds);
    item->setData(1, kTimes, 1);
    item->setToolTip(1, what);
    times_.push_back(seconds);
}

void MomentList::add_counted(double seconds, const QString& what) {
    if (!std::isfinite(seconds)) return;
    QTreeWidgetItem*& same = counted_[what];
    if (same == nullptr) {
        add(seconds, what);
        same = topLevelItem(topLevelItemCount() - 1);
        return;
    }
    const int times = same->data(1, kTimes).toInt() + 1;
    same->setData(1, kTimes, times);
    same->setText(1, tr("%1 (%2 times)").arg(what).arg(times));
}

void MomentList::finish() {
    sortItems(0, Qt::AscendingOrder);
    std::ranges::sort(times_);
}

void MomentList::show_time(double time) {
    const auto next = std::upper_bound(times_.begin(), times_.end(), time + kSame);
    QTreeWidgetItem* const item = next == times_.begin()
                                      ? nullptr
                                      : topLevelItem(static_cast<int>(next - times_.begin()) - 1);
    // of several moments at the same time, the one that was clicked stays marked
    const auto time_of = [](const QTreeWidgetItem* of) {
        return of == nullptr ? -HUGE_VAL : of->data(0, kTime).toDouble();
    };
    if (time_of(item) == time_of(currentItem())) return;
    setCurrentItem(item);
    if (item != nullptr) scrollToItem(item);
}

std::optional<double> MomentList::next_from(double time, int way) const {
    if (way > 0) {
        const auto next = std::upper_bound(times_.begin(), times_.end(), time + kSame);
        return next == times_.end() ? std::nullopt : std::optional(*next);
    }
    const auto next = std::lower_bound(times_.begin(), times_.end(), time - kSame);
    return next == times_.begin() ? std::nullopt : std::optional(*std::prev(next));
}

}  // namespace dihaptic::gui
