// The variance shadow map: a pyramid of the first two moments of depth (README.md). Only for use by
// the sources in this folder.
#pragma once

#include <functional>
#include <vector>

#include "view/gl.h"

namespace dihaptic::view {

class ShadowMap {
  public:
    /// `size`: width of the finest level in texels, a power of two. The coarsest level is sixteen
    /// texels wide.
    explicit ShadowMap(int size);

    /// Renders the moments. `light_from_world` transforms W to x and y, which range from -1 to 1
    /// over the map, and z, the depth along the light [m]. `draw` must draw everything that casts
    /// or receives shadows, and set world_from_model for each model. `depth_range`: largest depth
    /// [m]. `texel`: size of a texel at the finest level [m]. `blurred`: if false, only the finest
    /// level is rendered, without blur. Leaves a different framebuffer bound.
    void render(const Eigen::Matrix4d& light_from_world, double depth_range, double texel,
                bool blurred, const std::function<void(const gl::Program&)>& draw) const;

    GLuint texture() const { return moments_; }
    int size() const { return size_; }

  private:
    void blur(int level) const;

    int size_;
    int levels_;
    gl::Program render_;
    gl::Program blur_;
    gl::VertexArray nothing_;
    gl::Texture moments_;
    gl::Texture rows_;  // result of blurring along the rows only
    gl::Renderbuffer depth_;
    std::vector<gl::Framebuffer> to_moments_;  // by level
    std::vector<gl::Framebuffer> to_rows_;
};

}  // namespace dihaptic::view
