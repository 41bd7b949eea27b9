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
        glDeleteShader(shader);  // only marks it: the shader is deleted with the program
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
    for (const GLuint attribute : {0U, 1U}) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(attribute * sizeof(Eigen::Vector3f)));
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
