// The source of the shaders. For the sources of this folder only.
#pragma once

namespace dihaptic::view::shaders {

extern const char* const kMomentsVertex;
extern const char* const kMomentsFragment;
extern const char* const kBlurVertex;  ///< one triangle over the whole framebuffer
extern const char* const kBlurFragment;
/// Functions background() and encode(), prepended to kBackgroundFragment and kSurfaceFragment.
extern const char* const kBackground;
extern const char* const kBackgroundFragment;
extern const char* const kSurfaceVertex;
extern const char* const kSurfaceFragment;

}  // namespace dihaptic::view::shaders
