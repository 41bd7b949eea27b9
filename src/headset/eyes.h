// The headset's session with OpenXR, from connecting to the runtime to handing over a picture for
// each eye.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include "headset/glx_context.h"
#include "headset/headset.h"
#include "headset/xr.h"
#include "view/panes.h"

namespace dihaptic::headset {

/// A swapchain: pictures in OpenGL's memory that the runtime shows.
struct Pictures {
    xr::Swapchain swapchain;
    std::vector<GLuint> textures;
    int width = 0, height = 0;  // [pixels]
};

class Eyes {
  public:
    static constexpr size_t kCount = 2;  // left, right

    /// Connects to the runtime. Throws Error if there is no runtime, no headset, or not the kind of
    /// space that `place` requires. `gl` must be current, and must outlive this object.
    Eyes(const display::Headset& place, const GlxContext& gl);
    Eyes(const Eyes&) = delete;
    Eyes& operator=(const Eyes&) = delete;

    /// A description of the runtime and the headset.
    std::string describe() const;
    /// Size of the picture for one eye [pixels].
    int width() const { return pictures_[0].width; }
    int height() const { return pictures_[0].height; }

    /// Handles the runtime's events. Returns whether the runtime needs pictures. Throws Error if
    /// the session has ended.
    bool wants_pictures();

    /// The viewpoints from which a picture is drawn.
    struct Look {
        XrTime time = 0;
        bool drawn = false;  ///< whether the picture will be visible
        std::array<view::Viewpoint, kCount> eyes;
        Pose X_WV;             ///< pose of the head
        bool tracked = false;  ///< whether the head's pose was measured
    };
    /// Waits until the next picture is due, and returns its viewpoints.
    Look begin_picture();
    /// Copies one eye's picture from the framebuffer that is bound for reading, starting at column
    /// `left`.
    void copy_from(size_t eye, int left);
    /// Redraws the words, which hang in front of the head at the head's pose in `look`.
    void set_words(const Words& words, const Look& look);
    /// Submits the picture. Returns the time at which its light appears.
    std::chrono::steady_clock::time_point end_picture(const Look& look);

  private:
    void connect();
    void check_graphics() const;
    void make_session(const GlxContext& gl);
    void make_space(display::HeadsetSpace kind);
    void make_pictures();
    Pictures make_pictures(int64_t format, int width, int height) const;
    void take_note_of(XrSessionState state);
    void check(XrResult result, const char* what) const { xr::check(instance_, result, what); }
    template <class Function>
    Function function(const char* name) const;
    Pose located(XrSpace space, XrTime time) const;
    std::chrono::steady_clock::time_point steady(XrTime time) const;

    display::Headset place_;
    Pose X_WS_;
    xr::Instance instance_;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    std::string runtime_, model_;
    // null if the runtime lacks the function
    PFN_xrConvertTimeToTimespecTimeKHR to_timespec_ = nullptr;
    xr::Session session_;
    xr::Space space_, head_;
    XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    std::array<Pictures, kCount> pictures_;
    Pictures words_;
    std::optional<Pose> X_SP_;  // pose of the panel that shows words; unset if there are no words
    std::array<XrView, kCount> views_{};
    bool running_ = false;
};

}  // namespace dihaptic::headset
