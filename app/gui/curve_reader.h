// Reads curves from a recorded session in a separate thread, because a session may have millions of
// ticks.
#pragma once

#include <QObject>
#include <QStringList>
#include <thread>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::gui {

/// The minimum and the maximum in each of several equal parts of a time interval; NaN if a part
/// contains no value.
struct RecordedCurve {
    QString name;  ///< the expression
    QString unit;
    std::vector<float> low;
    std::vector<float> high;
};

class CurveReader : public QObject {
    Q_OBJECT

  public:
    /// Number of parts into which the interval is divided.
    static constexpr size_t kParts = 1500;

    using QObject::QObject;

    struct Wanted {
        std::string log;
        scene::Scene scene;
        QStringList expressions;
        double begin = 0;  ///< start of the interval [s]
        double end = 0;
    };
    /// Starts reading these curves; earlier requests are dropped.
    void read(const Wanted& wanted);

  Q_SIGNALS:
    /// All curves, each up to the point reached so far. `share`: share of the interval that has
    /// been read.
    void progressed(const std::vector<dihaptic::gui::RecordedCurve>& curves, double share);

  private:
    void run(const Wanted& wanted, const std::stop_token& stop);

    std::jthread thread_;
};

}  // namespace dihaptic::gui
