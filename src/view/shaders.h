// The source code of the shaders. Only for use by the sources in this folder.
#pragma once

namespace dihaptic::view::shaders {

extern const char* const kMomentsVertex;
extern const char* const kMomentsFragment;
extern const char* const kBlurVertex;  ///< draws one triangle over the whole framebuffer
extern const char* const kBlurFragment;
/// The functions background() and encode(), to be prepended to kBackgroundFragment and
/// kSurfaceFragment.
extern const char* const kBackground;
extern const char* const kBackgroundFragment;
extern const char* const kSurfaceVertex;
extern const char* const kSurfaceFragment;

}  // namespace dihaptic::view::shaders
