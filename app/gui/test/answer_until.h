// Runs the window's event loop in tests until a condition holds.
#pragma once

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QThread>

namespace dihaptic::gui {

/// Handles events until `condition` holds, and calls `each_time` in between. Returns false if this
/// takes longer than twenty seconds.
template <class Condition, class Step>
bool answer_until(const Condition& condition, const Step& each_time) {
    constexpr qint64 kPatience = 20000;  // [ms]
    QElapsedTimer timer;
    timer.start();
    while (!condition()) {
        if (timer.elapsed() > kPatience) return false;
        QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
        each_time();
        QThread::msleep(5);
    }
    return true;
}

template <class Condition>
bool answer_until(const Condition& condition) {
    return answer_until(condition, [] {});
}

}  // namespace dihaptic::gui
