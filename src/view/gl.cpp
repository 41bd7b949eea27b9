#include "view/gl.h"

#include <array>

#include "base/diagnostics.h"

namespace dihaptic::view::gl {
namespace {

GLuint compile(GLenum kind, const std::string& text) {
    const GLuint shader = glCreateShader(kind);
    const std::string whole = "#version 330 core\n" + text;
    const char* source = whole.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    return shader;
}

}  // namespace

Program::Program(const std::string& vertex, const std::string& fragment)
    : name_(glCreateProgram()) {
    std::array<char, 2000> log{};
    for (const auto& [kind, text] :
         {std::pair{GL_VERTEX_SHADER, &vertex}, std::pair{GL_FRAGMENT_SHADER, &fragment}}) {
        const GLuint shader = compile(static_cast<GLenum>(kind), *text);
        glAttachShader(name_, shader);
        glDeleteShader(shader);  // only marks it: it is deleted together with the program
        if (log[0] == 0) glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    }
    glLinkProgram(name_);
    GLint linked = 0;
    glGetProgramiv(name_, GL_LINK_STATUS, &linked);
    if (linked != 0) return;
    if (log[0] == 0) glGetProgramInfoLog(name_, log.size(), nullptr, log.data());
    throw Error(std::string("the graphics driver refuses a shader: ") + log.data(),
                "Update the driver, or draw in software: LIBGL_ALWAYS_SOFTWARE=1 dihaptic ...");
}

Texture make_texture(const Image& image) {
    Texture texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 image.rgb.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    return texture;
}

Model::Model(const Triangles& triangles) : count_(static_cast<GLsizei>(triangles.indices.size())) {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    array_ = VertexArray(name);
    glBindVertexArray(array_);
    const auto fill = [&](GLenum target, const void* data, size_t bytes) {
        glGenBuffers(1, &name);
        glBindBuffer(target, name);
        glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
        return Buffer(name);
    };
    vertices_ = fill(GL_ARRAY_BUFFER, triangles.vertices.data(),
                     triangles.vertices.size() * sizeof(Vertex));
    indices_ = fill(GL_ELEMENT_ARRAY_BUFFER, triangles.indices.data(),
                    triangles.indices.size() * sizeof(uint32_t));
    const auto describe = [](GLuint attribute, size_t stride, size_t offset) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                              reinterpret_cast<const void*>(offset));
    };
    describe(0, sizeof(Vertex), 0);
    describe(1, sizeof(Vertex), sizeof(Eigen::Vector3f));
    if (!triangles.colours.empty()) {
        colours_ = fill(GL_ARRAY_BUFFER, triangles.colours.data(),
                        triangles.colours.size() * sizeof(Eigen::Vector3f));
        describe(2, sizeof(Eigen::Vector3f), 0);
    }
    glBindVertexArray(0);
}

void Model::draw() const {
    if (count_ == 0) return;
    glBindVertexArray(array_);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

}  // namespace dihaptic::view::gl
