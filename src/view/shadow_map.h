// The variance shadow map: a pyramid of the first two moments of depth (README.md). For the sources
// of this folder only.
#pragma once

#include <functional>
#include <vector>

#include "view/gl.h"

namespace dihaptic::view {

class ShadowMap {
  public:
    /// `size`: number of texels across the finest level, a power of two. The coarsest level has
    /// sixteen.
    explicit ShadowMap(int size);

    /// Renders moments. `light_from_world` takes W to x, y from -1 to 1 over the map and z, the
    /// depth along the light [m]. `draw` draws everything that casts and receives shadows, and sets
    /// world_from_model for each model. `depth_range`: largest depth [m]; `texel`: size of a texel
    /// of the finest level [m]. Without `blurred`, only the finest level is rendered, and it is
    /// left unblurred. Leaves another framebuffer bound.
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
    gl::Texture rows_;  // blurred along rows only
    gl::Renderbuffer depth_;
    std::vector<gl::Framebuffer> to_moments_;  // by level
    std::vector<gl::Framebuffer> to_rows_;
};

}  // namespace dihaptic::view
