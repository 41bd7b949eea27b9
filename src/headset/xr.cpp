#include "headset/xr.h"

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/number.h"

namespace dihaptic::headset::xr {

void check(XrInstance instance, XrResult result, const char* what) {
    if (XR_SUCCEEDED(result)) return;
    std::string said = number_text(result);
    char name[XR_MAX_RESULT_STRING_SIZE];
    if (instance != XR_NULL_HANDLE && XR_SUCCEEDED(xrResultToString(instance, result, name)))
        said = name;
    throw Error(fmt::format("the headset's runtime refuses {}: {}", what, said),
                "Check the runtime's own messages, and restart it.");
}

XrPosef to_xr(const Pose& X) {
    const Eigen::Quaternionf R = Eigen::Quaterniond(X.R).cast<float>().normalized();
    const Eigen::Vector3f p = X.p.cast<float>();
    return {{R.x(), R.y(), R.z(), R.w()}, {p.x(), p.y(), p.z()}};
}

Pose from_xr(const XrPosef& X) {
    Quat R(X.orientation.w, X.orientation.x, X.orientation.y, X.orientation.z);
    R.normalize();
    return {R, {X.position.x, X.position.y, X.position.z}};
}

}  // namespace dihaptic::headset::xr
