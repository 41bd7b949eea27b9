// OpenXR objects that are destroyed at the end of their scope, and OpenXR results converted to
// errors in words.
#pragma once

#include <string>
#include <utility>

#include "base/geometry.h"
#include "headset/xr_platform.h"

namespace dihaptic::headset::xr {

/// An OpenXR object, which the destructor destroys.
template <class Handle, auto Destroy>
class Owned {
  public:
    Owned() = default;
    ~Owned() {
        if (handle_ != XR_NULL_HANDLE) Destroy(handle_);
    }
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, Handle(XR_NULL_HANDLE))) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    operator Handle() const { return handle_; }
    /// The address at which the function that creates the object stores it.
    Handle* out() { return &handle_; }

  private:
    Handle handle_ = XR_NULL_HANDLE;
};

using Instance = Owned<XrInstance, xrDestroyInstance>;
using Session = Owned<XrSession, xrDestroySession>;
using Space = Owned<XrSpace, xrDestroySpace>;
using Swapchain = Owned<XrSwapchain, xrDestroySwapchain>;

/// Throws Error if the call of a function, named `what` in the message, did not succeed.
void check(XrInstance instance, XrResult result, const char* what);

/// Converts the pose of a frame in a space to OpenXR's type.
XrPosef to_xr(const Pose& X);
Pose from_xr(const XrPosef& X);

}  // namespace dihaptic::headset::xr
