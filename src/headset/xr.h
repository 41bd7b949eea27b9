// OpenXR's objects, destroyed at the end of their scope, and its results as errors in words.
#pragma once

#include <string>
#include <utility>

#include "base/geometry.h"
#include "headset/xr_platform.h"

namespace dihaptic::headset::xr {

/// An object of OpenXR, which the destructor destroys.
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
    /// The place where a function that makes the object stores it.
    Handle* out() { return &handle_; }

  private:
    Handle handle_ = XR_NULL_HANDLE;
};

using Instance = Owned<XrInstance, xrDestroyInstance>;
using Session = Owned<XrSession, xrDestroySession>;
using Space = Owned<XrSpace, xrDestroySpace>;
using Swapchain = Owned<XrSwapchain, xrDestroySwapchain>;

/// Throws Error when a function called `what` did not succeed.
void check(XrInstance instance, XrResult result, const char* what);

/// OpenXR's pose: R and p of a frame in a space.
XrPosef to_xr(const Pose& X);
Pose from_xr(const XrPosef& X);

}  // namespace dihaptic::headset::xr
