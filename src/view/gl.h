// OpenGL objects that are deleted at the end of their scope. Only for use by the sources in this
// folder.
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "base/geometry.h"
#include "base/image.h"
#include "view/triangles.h"

namespace dihaptic::view::gl {

/// The name (handle) of an OpenGL object. The destructor deletes the object.
template <auto Delete>
class Name {
  public:
    Name() = default;
    explicit Name(GLuint name) : name_(name) {}
    ~Name() {
        if (name_ != 0) Delete(name_);
    }
    Name(Name&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Name& operator=(Name&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    operator GLuint() const { return name_; }

  private:
    GLuint name_ = 0;
};

inline void delete_buffer(GLuint n) {
    glDeleteBuffers(1, &n);
}
inline void delete_vertex_array(GLuint n) {
    glDeleteVertexArrays(1, &n);
}
inline void delete_texture(GLuint n) {
    glDeleteTextures(1, &n);
}
inline void delete_framebuffer(GLuint n) {
    glDeleteFramebuffers(1, &n);
}
inline void delete_renderbuffer(GLuint n) {
    glDeleteRenderbuffers(1, &n);
}
inline void delete_program(GLuint n) {
    glDeleteProgram(n);
}

using Buffer = Name<delete_buffer>;
using VertexArray = Name<delete_vertex_array>;
using Texture = Name<delete_texture>;
using Framebuffer = Name<delete_framebuffer>;
using Renderbuffer = Name<delete_renderbuffer>;

inline Texture make_texture() {
    GLuint n = 0;
    glGenTextures(1, &n);
    return Texture(n);
}
inline Framebuffer make_framebuffer() {
    GLuint n = 0;
    glGenFramebuffers(1, &n);
    return Framebuffer(n);
}
inline Renderbuffer make_renderbuffer() {
    GLuint n = 0;
    glGenRenderbuffers(1, &n);
    return Renderbuffer(n);
}

/// Makes a texture that repeats a picture. Shaders read it as linear light.
Texture make_texture(const Image& image);

/// A linked vertex and fragment shader. Their source is given without the line "#version 330 core".
class Program {
  public:
    Program(const std::string& vertex, const std::string& fragment);
    void use() const { glUseProgram(name_); }
    void set(const char* uniform, int value) const { glUniform1i(at(uniform), value); }
    void set(const char* uniform, double value) const {
        glUniform1f(at(uniform), static_cast<float>(value));
    }
    void set(const char* uniform, const Eigen::Vector2d& value) const {
        const Eigen::Vector2f v = value.cast<float>();
        glUniform2fv(at(uniform), 1, v.data());
    }
    void set(const char* uniform, const Vec3& value) const {
        const Eigen::Vector3f v = value.cast<float>();
        glUniform3fv(at(uniform), 1, v.data());
    }
    void set(const char* uniform, const Eigen::Matrix4d& value) const {
        const Eigen::Matrix4f v = value.cast<float>();
        glUniformMatrix4fv(at(uniform), 1, GL_FALSE, v.data());
    }

  private:
    GLint at(const char* uniform) const { return glGetUniformLocation(name_, uniform); }
    Name<delete_program> name_;
};

/// Triangles in OpenGL's memory. Attribute 0 contains positions, attribute 1 normals and attribute
/// 2 colours, if there are any.
class Model {
  public:
    Model() = default;
    explicit Model(const Triangles& triangles);
    void draw() const;

  private:
    VertexArray array_;
    Buffer vertices_;
    Buffer colours_;
    Buffer indices_;
    GLsizei count_ = 0;
};

inline Eigen::Matrix4d matrix(const Pose& X) {
    Eigen::Matrix4d out = Eigen::Matrix4d::Identity();
    out.topLeftCorner<3, 3>() = X.R.toRotationMatrix();
    out.topRightCorner<3, 1>() = X.p;
    return out;
}

}  // namespace dihaptic::view::gl
