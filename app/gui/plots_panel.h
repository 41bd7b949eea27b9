// The panel with live curves of the grip force and the load force, of the force on each finger, and
// of heights.
#pragma once

#include "scene/scene.h"
#include "session/listeners/live.h"
#include "strip_chart.h"

class QVBoxLayout;

namespace dihaptic::gui {

class PlotsPanel : public QWidget {
    Q_OBJECT

  public:
    explicit PlotsPanel(QWidget* parent = nullptr);

    void set_scene(const scene::Scene& scene);
    void add(const session::CurveSample& sample);

  private:
    QVBoxLayout* layout_;
    StripChart* grasp_ = nullptr;
    StripChart* fingers_ = nullptr;
    StripChart* heights_ = nullptr;
    size_t fingers_count_ = 0;
    bool has_object_ = false;
};

}  // namespace dihaptic::gui
