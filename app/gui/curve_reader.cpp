#include "curve_reader.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "recording/log_browser.h"
#include "task/run/recorded.h"

namespace dihaptic::gui {

void CurveReader::read(const Wanted& wanted) {
    thread_ = std::jthread([this, wanted](const std::stop_token& stop) { run(wanted, stop); });
}

void CurveReader::run(const Wanted& wanted, const std::stop_token& stop) {
    std::vector<task::RecordedValue> values;
    std::vector<RecordedCurve> curves;
    for (const QString& text : wanted.expressions) {
        Diagnostics ignored;  // the caller has checked the expressions
        task::RecordedValue& value = values.emplace_back(text.toStdString(), wanted.scene, ignored);
        RecordedCurve& curve = curves.emplace_back();
        curve.name = text;
        curve.unit = QString::fromStdString(value.unit());
        curve.low.assign(kParts, std::numeric_limits<float>::quiet_NaN());
        curve.high = curve.low;
    }
    const auto tell = [&](double share) {
        QMetaObject::invokeMethod(
            this,
            [this, curves, share, stop] {
                if (!stop.stop_requested()) Q_EMIT progressed(curves, share);
            },
            Qt::QueuedConnection);
    };
    using Clock = std::chrono::steady_clock;
    Clock::time_point told = Clock::now();
    const double span = std::max(wanted.end - wanted.begin, 1e-9);
    try {
        recording::LogBrowser log(wanted.log);
        const frame::Frame* frame = &log.at(wanted.begin);
        for (; frame != nullptr && !stop.stop_requested(); frame = log.next()) {
            const double share = (seconds(frame->time) - wanted.begin) / span;
            if (share > 1) break;
            if (share < 0) continue;
            const auto part = std::min(static_cast<size_t>(share * kParts), kParts - 1);
            for (size_t i = 0; i < values.size(); ++i) {
                const auto value = static_cast<float>(values[i](*frame));
                curves[i].low[part] = std::fmin(curves[i].low[part], value);
                curves[i].high[part] = std::fmax(curves[i].high[part], value);
            }
            if (frame->sequence % 1000 != 0) continue;
            if (Clock::now() - told < std::chrono::milliseconds(200)) continue;
            told = Clock::now();
            tell(share);
        }
    } catch (const Error&) {
        // the log existed when the session was opened, so the part read so far is shown
    }
    if (!stop.stop_requested()) tell(1);
}

}  // namespace dihaptic::gui
