#include "view/offscreen.h"

#include <epoxy/egl.h>

#include <algorithm>
#include <array>

#include "base/diagnostics.h"
#include "view/gl.h"
#include "view/scene_view.h"

namespace dihaptic::view {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw Error("OpenGL 3.3, which drawing requires, is missing: " + what,
                "Install the Debian packages libegl1, libegl-mesa0 and libgl1-mesa-dri.");
}

}  // namespace

struct Offscreen::Context {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    gl::Framebuffer framebuffer;
    gl::Renderbuffer colour;

    ~Context() {
        if (context != EGL_NO_CONTEXT) {
            framebuffer = {};
            colour = {};
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            eglDestroyContext(display, context);
        }
        // the display is not closed, because it is shared by the process: another Offscreen may be
        // using it
    }
};

Offscreen::Offscreen(int width, int height)
    : context_(std::make_unique<Context>()), width_(width), height_(height) {
    Context& c = *context_;
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        fail("EGL does not support drawing without a window");
    c.display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (c.display == EGL_NO_DISPLAY || eglInitialize(c.display, nullptr, nullptr) == EGL_FALSE)
        fail("EGL cannot be started");
    eglBindAPI(EGL_OPENGL_API);
    const std::array<EGLint, 7> wanted{EGL_CONTEXT_MAJOR_VERSION,
                                       3,
                                       EGL_CONTEXT_MINOR_VERSION,
                                       3,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                       EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       EGL_NONE};
    c.context = eglCreateContext(c.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
    if (c.context == EGL_NO_CONTEXT ||
        eglMakeCurrent(c.display, EGL_NO_SURFACE, EGL_NO_SURFACE, c.context) == EGL_FALSE)
        fail("the driver offers only older versions");
    c.framebuffer = gl::make_framebuffer();
    c.colour = gl::make_renderbuffer();
    glBindRenderbuffer(GL_RENDERBUFFER, c.colour);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, c.framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, c.colour);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("a picture of this size does not fit into its memory");
}

Offscreen::~Offscreen() = default;

std::string Offscreen::renderer() const {
    return view::renderer();
}

void Offscreen::wait() const {
    glFinish();
}

Image Offscreen::read() const {
    Image image{width_, height_, {}};
    const size_t row = 3 * static_cast<size_t>(width_);
    image.rgb.resize(row * static_cast<size_t>(height_));
    glBindFramebuffer(GL_FRAMEBUFFER, context_->framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    // OpenGL stores rows from bottom to top
    for (size_t y = 0; y < static_cast<size_t>(height_) / 2; ++y) {
        auto* const low = &image.rgb[y * row];
        std::swap_ranges(low, low + row, &image.rgb[(static_cast<size_t>(height_) - 1 - y) * row]);
    }
    return image;
}

}  // namespace dihaptic::view
