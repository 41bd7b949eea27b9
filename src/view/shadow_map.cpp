#include "view/shadow_map.h"

#include <array>

#include "view/shaders.h"

namespace dihaptic::view {
namespace {

int levels_of(int size) {
    int levels = 1;
    while (size >> levels >= 16) ++levels;
    return levels;
}

gl::Texture make_moments(int size) {
    gl::Texture texture = gl::make_texture();
    glBindTexture(GL_TEXTURE_2D, texture);
    const int levels = levels_of(size);
    for (int i = 0; i < levels; ++i)
        glTexImage2D(GL_TEXTURE_2D, i, GL_RG32F, size >> i, size >> i, 0, GL_RG, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, levels - 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

std::vector<gl::Framebuffer> make_targets(GLuint texture, int levels) {
    std::vector<gl::Framebuffer> out;
    for (int i = 0; i < levels; ++i) {
        out.push_back(gl::make_framebuffer());
        glBindFramebuffer(GL_FRAMEBUFFER, out.back());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, i);
    }
    return out;
}

}  // namespace

ShadowMap::ShadowMap(int size)
    : size_(size),
      levels_(levels_of(size)),
      render_(shaders::kMomentsVertex, shaders::kMomentsFragment),
      blur_(shaders::kBlurVertex, shaders::kBlurFragment),
      moments_(make_moments(size)),
      rows_(make_moments(size)),
      depth_(gl::make_renderbuffer()),
      to_moments_(make_targets(moments_, levels_)),
      to_rows_(make_targets(rows_, levels_)) {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    nothing_ = gl::VertexArray(name);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, size_, size_);
    glBindFramebuffer(GL_FRAMEBUFFER, to_moments_.front());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
}

void ShadowMap::render(const Eigen::Matrix4d& light_from_world, double depth_range, double texel,
                       bool blurred, const std::function<void(const gl::Program&)>& draw) const {
    glBindFramebuffer(GL_FRAMEBUFFER, to_moments_.front());
    glViewport(0, 0, size_, size_);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    const auto far = static_cast<float>(depth_range);
    const std::array<float, 4> nothing{far, far * far, 0, 0};
    const float furthest = 1;
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glClearBufferfv(GL_DEPTH, 0, &furthest);
    render_.use();
    render_.set("light_from_world", light_from_world);
    render_.set("depth_range", depth_range);
    render_.set("texel", texel);
    draw(render_);
    if (!blurred) return;
    glDisable(GL_DEPTH_TEST);
    blur_.use();
    blur_.set("source", 0);
    glActiveTexture(GL_TEXTURE0);
    glBindVertexArray(nothing_);
    for (int i = 0; i < levels_; ++i) blur(i);
    glBindVertexArray(0);
}

/// Blurs along the rows into the other texture, and from there along the columns back into this
/// one. Except at the finest level, the rows are read from the next finer level: two of its texels
/// make one texel of this level, and linear interpolation gives their mean.
void ShadowMap::blur(int level) const {
    const int size = size_ >> level;
    const int from = level > 0 ? level - 1 : 0;
    glViewport(0, 0, size, size);
    const auto pass = [&](GLuint source, int source_level, GLuint target,
                          const Eigen::Vector2d& texel) {
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        glBindTexture(GL_TEXTURE_2D, source);
        // rendering to one level of a texture while reading another is defined only if the reading
        // is limited to that other level
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, source_level);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, source_level);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        blur_.set("texel", texel);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, levels_ - 1);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    };
    const auto at = static_cast<size_t>(level);
    pass(moments_, from, to_rows_[at], {1.0 / size, 0});
    pass(rows_, level, to_moments_[at], {0, 1.0 / size});
}

}  // namespace dihaptic::view
