// The shaders' source. For the room's own sources only.
#pragma once

namespace dihaptic::view::shaders {

extern const char* const kMomentsVertex;
extern const char* const kMomentsFragment;
extern const char* const kBlurVertex;  ///< one triangle over the whole framebuffer
extern const char* const kBlurFragment;
extern const char* const kBackground;  ///< function background(), for the two that follow
extern const char* const kBackgroundFragment;
extern const char* const kSurfaceVertex;
extern const char* const kSurfaceFragment;

}  // namespace dihaptic::view::shaders
