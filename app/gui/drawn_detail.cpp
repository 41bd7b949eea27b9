#include "drawn_detail.h"

#include <utility>

namespace dihaptic::gui {
namespace {

constexpr double kCoarse = 2.0 / 3;  // detail of moving pictures when drawing is slow
constexpr int kUntilStill = 200;     // without a new picture for so long, nothing moves [ms]
constexpr int kUntilOver = 2000;     // nor without a new frame: a busy computer delays them [ms]

}  // namespace

DrawnDetail::DrawnDetail(const std::function<void()>& draw) {
    still_.setSingleShot(true);
    still_.callOnTimeout([this, draw] {
        is_still_ = true;
        draw();
    });
}

bool DrawnDetail::draws_slowly() {
    if (fine_) return false;
    fine_ = false;
    return true;
}

double DrawnDetail::next() {
    const bool all = std::exchange(is_still_, false) || fine_ != false;
    const bool runs = since_frame_.isValid() && !since_frame_.hasExpired(kUntilOver);
    if (!all) still_.start(runs ? kUntilOver : kUntilStill);
    return all ? 1 : kCoarse;
}

}  // namespace dihaptic::gui
