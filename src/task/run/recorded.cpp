#include "task/run/recorded.h"

#include "task/plan/lookup.h"

namespace dihaptic::task {

void handles_of(const frame::Frame& frame, std::vector<frame::Handle>& out) {
    out.resize(frame.fingers.size());
    for (size_t i = 0; i < out.size(); ++i) {
        out[i].p_WH = frame.fingers[i].p_WH;
        out[i].v_WH = frame.fingers[i].v_WH;
        if (frame.turns.size() != out.size()) continue;
        out[i].R_WH = frame.turns[i].R_WH;
        out[i].w_WH = frame.turns[i].w_WH;
    }
}

RecordedValue::RecordedValue(const std::string& text, const scene::Scene& scene,
                             Diagnostics& diagnostics)
    : quantities_({.fingers = scene::finger_names(scene),
                   .bodies = names_of(scene.bodies),
                   .joints = names_of(recorded_joints(scene)),
                   .regions = {},
                   .hands = {}}),
      expression_(Expression::compile(text, quantities_, {}, "curve", diagnostics)),
      unit_(si_symbol(expression_.dimension())) {
    if (!(expression_.dimension() == dimension(Quantity::length))) return;
    unit_ = "mm";
    scale_ = 1e3;
}

double RecordedValue::operator()(const frame::Frame& frame) {
    handles_of(frame, handles_);
    quantities_.update(frame, handles_);
    return scale_ * expression_(quantities_.values());
}

}  // namespace dihaptic::task
