#include "headset/eyes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/diagnostics.h"

namespace dihaptic::headset {
namespace {

constexpr auto kViews = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr double kNearest = 0.03, kFurthest = 30;  // limits of the drawn range from an eye [m]
constexpr double kPanel = 1;                       // width of the panel that shows words [m]
constexpr double kPanelAhead = 1;                  // distance of the panel from the head [m]

/// Returns the items that a function lists in two calls: the first returns their number, the second
/// the items themselves.
template <class Item, class List>
std::vector<Item> listed(const List& list, const Item& empty) {
    uint32_t count = 0;
    list(0, &count, nullptr);
    std::vector<Item> out(count, empty);
    if (count > 0) list(count, &count, out.data());
    out.resize(count);
    return out;
}

bool has_extension(const char* name) {
    const auto all = listed(
        [](uint32_t room, uint32_t* count, XrExtensionProperties* out) {
            xrEnumerateInstanceExtensionProperties(nullptr, room, count, out);
        },
        xr::made<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
    return std::any_of(all.begin(), all.end(), [&](const XrExtensionProperties& is) {
        return std::strcmp(is.extensionName, name) == 0;
    });
}

view::FieldOfView from_xr(const XrFovf& fov) {
    return {fov.angleLeft, fov.angleRight, fov.angleUp, fov.angleDown};
}

/// Returns the sub-image that covers the whole picture of an eye or a panel.
XrSwapchainSubImage whole(const Pictures& pictures) {
    XrSwapchainSubImage out{};
    out.swapchain = pictures.swapchain;
    out.imageRect.extent = {pictures.width, pictures.height};
    return out;
}

/// Waits for a free picture to draw in, and returns it to the runtime at the end of the scope.
class Taken {
  public:
    explicit Taken(const Pictures& pictures) : pictures_(pictures) {
        xrAcquireSwapchainImage(pictures.swapchain, nullptr, &index_);
        auto wait = xr::made<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
        wait.timeout = XR_INFINITE_DURATION;
        xrWaitSwapchainImage(pictures.swapchain, &wait);
    }
    ~Taken() { xrReleaseSwapchainImage(pictures_.swapchain, nullptr); }
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;

    GLuint texture() const { return pictures_.textures[index_]; }

  private:
    const Pictures& pictures_;
    uint32_t index_ = 0;
};

}  // namespace

Eyes::Eyes(const display::Headset& place, const GlxContext& gl)
    : place_(place), X_WS_(place.X_WS()) {
    connect();
    make_session(gl);
    make_space(place.space);
    make_pictures();
}

std::string Eyes::describe() const {
    return fmt::format("headset: {} by {}, {} x {} pixels for each eye", model_, runtime_, width(),
                       height());
}

template <class Function>
Function Eyes::function(const char* name) const {
    PFN_xrVoidFunction out = nullptr;
    check(xrGetInstanceProcAddr(instance_, name, &out), name);
    return reinterpret_cast<Function>(out);
}

void Eyes::connect() {
    const bool timed = has_extension(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
    const std::array<const char*, 2> extensions{XR_KHR_OPENGL_ENABLE_EXTENSION_NAME,
                                                XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};
    auto info = xr::made<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
    std::strcpy(info.applicationInfo.applicationName, "Dihaptic");
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionNames = extensions.data();
    info.enabledExtensionCount = timed ? 2 : 1;
    switch (const XrResult result = xrCreateInstance(&info, instance_.out())) {
        case XR_ERROR_RUNTIME_UNAVAILABLE:
        case XR_ERROR_RUNTIME_FAILURE:
            throw Error("there is no OpenXR runtime, or it is not running",
                        "Start the headset's own runtime, such as Monado or SteamVR, and make it "
                        "the active one: ~/.config/openxr/1/active_runtime.json.");
        case XR_ERROR_EXTENSION_NOT_PRESENT:
            throw Error(
                "the active OpenXR runtime does not support OpenGL",
                "Make another runtime the active one: ~/.config/openxr/1/active_runtime.json.");
        default:
            check(result, "xrCreateInstance");
    }
    auto runtime = xr::made<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
    check(xrGetInstanceProperties(instance_, &runtime), "xrGetInstanceProperties");
    runtime_ = runtime.runtimeName;
    if (timed)
        to_timespec_ =
            function<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");

    auto get = xr::made<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
    get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    const XrResult found = xrGetSystem(instance_, &get, &system_);
    if (found == XR_ERROR_FORM_FACTOR_UNAVAILABLE || found == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
        throw Error(
            fmt::format("{} does not find a headset", runtime_),
            "Connect the headset and switch it on; then open the participant's window again.");
    check(found, "xrGetSystem");
    auto system = xr::made<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
    check(xrGetSystemProperties(instance_, system_, &system), "xrGetSystemProperties");
    model_ = system.systemName;
}

/// Queries the graphics requirements, which a runtime demands before a session is created.
void Eyes::check_graphics() const {
    const auto requirements =
        function<PFN_xrGetOpenGLGraphicsRequirementsKHR>("xrGetOpenGLGraphicsRequirementsKHR");
    auto needs =
        xr::made<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
    check(requirements(instance_, system_, &needs), "xrGetOpenGLGraphicsRequirementsKHR");
    const int have = epoxy_gl_version();
    if (XR_MAKE_VERSION(have / 10, have % 10, 0) < needs.minApiVersionSupported)
        throw Error(
            fmt::format("{} needs OpenGL {}.{}, but the driver has {}.{}", runtime_,
                        XR_VERSION_MAJOR(needs.minApiVersionSupported),
                        XR_VERSION_MINOR(needs.minApiVersionSupported), have / 10, have % 10),
            "Update the graphics driver.");
}

void Eyes::make_session(const GlxContext& gl) {
    check_graphics();
    const XrGraphicsBindingOpenGLXlibKHR binding = gl.binding();
    auto info = xr::made<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
    info.next = &binding;
    info.systemId = system_;
    check(xrCreateSession(instance_, &info, session_.out()), "xrCreateSession");
    const auto blends = listed(
        [&](uint32_t room, uint32_t* count, XrEnvironmentBlendMode* out) {
            xrEnumerateEnvironmentBlendModes(instance_, system_, kViews, room, count, out);
        },
        XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
    if (!blends.empty()) blend_ = blends.front();
}

void Eyes::make_space(display::HeadsetSpace kind) {
    const auto all = listed(
        [&](uint32_t room, uint32_t* count, XrReferenceSpaceType* out) {
            xrEnumerateReferenceSpaces(session_, room, count, out);
        },
        XR_REFERENCE_SPACE_TYPE_LOCAL);
    const auto wanted = kind == display::HeadsetSpace::stage ? XR_REFERENCE_SPACE_TYPE_STAGE
                                                             : XR_REFERENCE_SPACE_TYPE_LOCAL;
    if (std::find(all.begin(), all.end(), wanted) == all.end())
        throw Error(place_.place, "space", "is 'stage', but the headset's runtime has no stage",
                    "Set up the room in the runtime, or write space: local.");
    auto info = xr::made<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
    info.poseInReferenceSpace = xr::to_xr({});
    info.referenceSpaceType = wanted;
    check(xrCreateReferenceSpace(session_, &info, space_.out()), "xrCreateReferenceSpace");
    info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_VIEW;
    check(xrCreateReferenceSpace(session_, &info, head_.out()), "xrCreateReferenceSpace");
}

void Eyes::make_pictures() {
    const auto formats =
        listed([&](uint32_t room, uint32_t* count,
                   int64_t* out) { xrEnumerateSwapchainFormats(session_, room, count, out); },
               int64_t{0});
    const std::array<int64_t, 2> usable{GL_SRGB8_ALPHA8, GL_RGBA8};
    const auto format =
        std::find_first_of(usable.begin(), usable.end(), formats.begin(), formats.end());
    if (format == usable.end())
        throw Error(fmt::format("{} does not support pictures with 8 bits per colour", runtime_),
                    "Use another runtime.");
    const auto views = listed(
        [&](uint32_t room, uint32_t* count, XrViewConfigurationView* out) {
            xrEnumerateViewConfigurationViews(instance_, system_, kViews, room, count, out);
        },
        xr::made<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
    if (views.size() != kCount)
        throw Error(fmt::format("{} does not show a separate picture to each eye", runtime_),
                    "Use another headset.");
    // both eyes have the same picture size, because they are drawn at once
    const auto width =
        std::max(views[0].recommendedImageRectWidth, views[1].recommendedImageRectWidth);
    const auto height =
        std::max(views[0].recommendedImageRectHeight, views[1].recommendedImageRectHeight);
    for (Pictures& pictures : pictures_)
        pictures = make_pictures(*format, static_cast<int>(width), static_cast<int>(height));
    words_ = make_pictures(*format, Words::kWidth, Words::kHeight);
    views_.fill(xr::made<XrView>(XR_TYPE_VIEW));
}

Pictures Eyes::make_pictures(int64_t format, int width, int height) const {
    Pictures out;
    out.width = width;
    out.height = height;
    auto info = xr::made<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = format;
    info.sampleCount = 1;
    info.width = static_cast<uint32_t>(width);
    info.height = static_cast<uint32_t>(height);
    info.faceCount = info.arraySize = info.mipCount = 1;
    check(xrCreateSwapchain(session_, &info, out.swapchain.out()), "xrCreateSwapchain");
    const auto images = listed(
        [&](uint32_t room, uint32_t* count, XrSwapchainImageOpenGLKHR* to) {
            xrEnumerateSwapchainImages(out.swapchain, room, count,
                                       reinterpret_cast<XrSwapchainImageBaseHeader*>(to));
        },
        xr::made<XrSwapchainImageOpenGLKHR>(XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
    for (const XrSwapchainImageOpenGLKHR& image : images) out.textures.push_back(image.image);
    return out;
}

bool Eyes::wants_pictures() {
    auto event = xr::made<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    while (xrPollEvent(instance_, &event) == XR_SUCCESS) {
        if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
            XrEventDataSessionStateChanged changed;
            std::memcpy(&changed, &event, sizeof changed);
            take_note_of(changed.state);
        } else if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
            take_note_of(XR_SESSION_STATE_LOSS_PENDING);
        }
        event = xr::made<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    }
    return running_;
}

void Eyes::take_note_of(XrSessionState state) {
    switch (state) {
        case XR_SESSION_STATE_READY: {
            auto info = xr::made<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
            info.primaryViewConfigurationType = kViews;
            check(xrBeginSession(session_, &info), "xrBeginSession");
            running_ = true;
            break;
        }
        case XR_SESSION_STATE_STOPPING:
            running_ = false;
            check(xrEndSession(session_), "xrEndSession");
            break;
        case XR_SESSION_STATE_EXITING:
        case XR_SESSION_STATE_LOSS_PENDING:
            throw Error(fmt::format("{} has ended the display in the headset", runtime_),
                        "Restart it, then open the participant's window again.");
        default:
            break;
    }
}

Pose Eyes::located(XrSpace space, XrTime time) const {
    auto location = xr::made<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    check(xrLocateSpace(space, space_, time, &location), "xrLocateSpace");
    return xr::from_xr(location.pose);
}

Eyes::Look Eyes::begin_picture() {
    auto frame = xr::made<XrFrameState>(XR_TYPE_FRAME_STATE);
    check(xrWaitFrame(session_, nullptr, &frame), "xrWaitFrame");
    check(xrBeginFrame(session_, nullptr), "xrBeginFrame");
    Look out;
    out.time = frame.predictedDisplayTime;
    if (frame.shouldRender == 0) return out;
    auto info = xr::made<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    info.viewConfigurationType = kViews;
    info.displayTime = out.time;
    info.space = space_;
    auto state = xr::made<XrViewState>(XR_TYPE_VIEW_STATE);
    uint32_t count = 0;
    check(xrLocateViews(session_, &info, &state, kCount, &count, views_.data()), "xrLocateViews");
    constexpr XrViewStateFlags kKnown =
        XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
    constexpr XrViewStateFlags kTracked =
        XR_VIEW_STATE_ORIENTATION_TRACKED_BIT | XR_VIEW_STATE_POSITION_TRACKED_BIT;
    out.drawn = (state.viewStateFlags & kKnown) == kKnown;
    if (!out.drawn) return out;
    out.tracked = (state.viewStateFlags & kTracked) == kTracked;
    out.X_WV = X_WS_ * located(head_, out.time);
    for (size_t eye = 0; eye < kCount; ++eye)
        out.eyes[eye] = view::viewpoint(X_WS_ * xr::from_xr(views_[eye].pose),
                                        from_xr(views_[eye].fov), kNearest, kFurthest);
    return out;
}

void Eyes::copy_from(size_t eye, int left) {
    const Pictures& to = pictures_[eye];
    const Taken taken(to);
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           taken.texture(), 0);
    // the scene is drawn as sRGB values, and the runtime reads them as sRGB
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBlitFramebuffer(left, 0, left + to.width, to.height, 0, 0, to.width, to.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glDeleteFramebuffers(1, &framebuffer);
}

void Eyes::set_words(const Words& words, const Look& look) {
    if (words.rgba.empty()) {
        X_SP_.reset();
        return;
    }
    const bool came = !X_SP_;
    constexpr size_t kRow = size_t{4} * Words::kWidth;
    const Taken taken(words_);
    glBindTexture(GL_TEXTURE_2D, taken.texture());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (int y = 0; y < Words::kHeight; ++y)  // rows in OpenGL go from bottom to top
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, Words::kHeight - 1 - y, Words::kWidth, 1, GL_RGBA,
                        GL_UNSIGNED_BYTE, &words.rgba[static_cast<size_t>(y) * kRow]);
    if (!came) return;
    // the panel is upright, in front of the head
    const Pose X_SV = X_WS_.inverse() * look.X_WV;
    const Vec3 backward = X_SV.R * Vec3::UnitZ();
    Vec3 right = Vec3::UnitY().cross(backward);
    if (right.norm() < 0.1) right = X_SV.R * Vec3::UnitX();
    right.normalize();
    Mat3 R;
    R << right, backward.cross(right), backward;
    X_SP_ = Pose{Quat(R), X_SV.p - kPanelAhead * backward};
}

std::chrono::steady_clock::time_point Eyes::steady(XrTime time) const {
    using Clock = std::chrono::steady_clock;
    timespec at{};
    if (to_timespec_ == nullptr || !XR_SUCCEEDED(to_timespec_(instance_, time, &at)))
        return Clock::now();
    // both times are on the CLOCK_MONOTONIC clock
    return Clock::time_point(std::chrono::seconds(at.tv_sec) +
                             std::chrono::nanoseconds(at.tv_nsec));
}

std::chrono::steady_clock::time_point Eyes::end_picture(const Look& look) {
    std::array<XrCompositionLayerProjectionView, kCount> views{};
    for (size_t eye = 0; eye < kCount; ++eye) {
        views[eye].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
        views[eye].pose = views_[eye].pose;
        views[eye].fov = views_[eye].fov;
        views[eye].subImage = whole(pictures_[eye]);
    }
    auto scene = xr::made<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
    scene.space = space_;
    scene.viewCount = kCount;
    scene.views = views.data();
    auto panel = xr::made<XrCompositionLayerQuad>(XR_TYPE_COMPOSITION_LAYER_QUAD);
    panel.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT |
                       XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;
    panel.space = space_;
    panel.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
    panel.subImage = whole(words_);
    panel.pose = xr::to_xr(X_SP_.value_or(Pose{}));
    panel.size = {kPanel, kPanel * Words::kHeight / Words::kWidth};
    const std::array<const XrCompositionLayerBaseHeader*, 2> layers{
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&scene),
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&panel)};
    auto info = xr::made<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
    info.displayTime = look.time;
    info.environmentBlendMode = blend_;
    info.layerCount = !look.drawn ? 0 : X_SP_ ? 2 : 1;
    info.layers = layers.data();
    check(xrEndFrame(session_, &info), "xrEndFrame");
    return steady(look.time);
}

}  // namespace dihaptic::headset
