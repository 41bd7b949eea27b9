// Values of expressions over recorded data, computed frame by frame.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "task/expression/expression.h"

namespace dihaptic::task {

/// Copies the handles in a frame to `out`.
void handles_of(const frame::Frame& frame, std::vector<frame::Handle>& out);

/// An expression over a recording whose task is not known: names that a task defines (regions,
/// variables, times in a state) are errors.
class RecordedValue {
  public:
    /// Mistakes are added to `diagnostics`, and the value is then 0.
    RecordedValue(const std::string& text, const scene::Scene& scene, Diagnostics& diagnostics);

    double operator()(const frame::Frame& frame);
    /// Unit of the value; mm for lengths.
    const std::string& unit() const { return unit_; }

  private:
    Quantities quantities_;
    Expression expression_;
    std::vector<frame::Handle> handles_;
    std::string unit_;
    double scale_ = 1;
};

}  // namespace dihaptic::task
