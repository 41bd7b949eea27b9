#include "headset/glx_context.h"

#include <array>

#include "base/diagnostics.h"

namespace dihaptic::headset {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw Error("OpenGL 3.3, which drawing for a headset requires, is missing: " + what,
                "Start the program on an X11 desktop, or on Wayland with XWayland.");
}

}  // namespace

GlxContext::GlxContext() {
    display_.reset(XOpenDisplay(nullptr));
    Display* const display = display_.get();
    if (display == nullptr) fail("no X11 display can be opened");
    constexpr int kNone = 0;
    const std::array<int, 9> wanted{GLX_DRAWABLE_TYPE,
                                    GLX_PBUFFER_BIT,
                                    GLX_RENDER_TYPE,
                                    GLX_RGBA_BIT,
                                    GLX_RED_SIZE,
                                    8,
                                    GLX_DOUBLEBUFFER,
                                    0,
                                    kNone};
    int count = 0;
    GLXFBConfig* const found =
        glXChooseFBConfig(display, DefaultScreen(display), wanted.data(), &count);
    if (found != nullptr && count > 0) config_ = found[0];
    if (found != nullptr) XFree(found);
    if (config_ == nullptr) fail("the display does not support drawing in memory");
    const std::array<int, 7> version{GLX_CONTEXT_MAJOR_VERSION_ARB,
                                     3,
                                     GLX_CONTEXT_MINOR_VERSION_ARB,
                                     3,
                                     GLX_CONTEXT_PROFILE_MASK_ARB,
                                     GLX_CONTEXT_CORE_PROFILE_BIT_ARB,
                                     kNone};
    context_ = glXCreateContextAttribsARB(display, config_, nullptr, 1, version.data());
    if (context_ == nullptr) fail("the driver offers only older versions");
    const std::array<int, 5> size{GLX_PBUFFER_WIDTH, 16, GLX_PBUFFER_HEIGHT, 16, kNone};
    surface_ = glXCreatePbuffer(display, config_, size.data());
    if (glXMakeContextCurrent(display, surface_, surface_, context_) == 0)
        fail("the driver refuses to draw without a window");
}

GlxContext::~GlxContext() {
    glXMakeContextCurrent(display_.get(), 0, 0, nullptr);
    glXDestroyPbuffer(display_.get(), surface_);
    glXDestroyContext(display_.get(), context_);
}

XrGraphicsBindingOpenGLXlibKHR GlxContext::binding() const {
    auto out = xr::made<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
    int visual = 0;
    glXGetFBConfigAttrib(display_.get(), config_, GLX_VISUAL_ID, &visual);
    out.xDisplay = display_.get();
    out.visualid = static_cast<uint32_t>(visual);
    out.glxFBConfig = config_;
    out.glxDrawable = surface_;
    out.glxContext = context_;
    return out;
}

}  // namespace dihaptic::headset
