// An OpenXR runtime for the tests. It does everything that the specification requires of a runtime
// with a stereo headset and OpenGL, but shows nothing. It writes every tenth picture to the folder
// named in DIHAPTIC_TEST_RUNTIME_PICTURES, as left.ppm, right.ppm and words.ppm. A file called
// `end` in that folder ends the session.
#include "runtime.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "../xr_platform.h"

namespace {

using namespace dihaptic::headset::test;
using dihaptic::headset::xr::made;

constexpr int kWidth = 640, kHeight = 720;
constexpr auto kPeriod = std::chrono::microseconds(11111);
constexpr auto kPatience = std::chrono::seconds(60);
constexpr uint32_t kImages = 3;

struct FakeSwapchain {
    std::vector<GLuint> textures;
    int width = 0, height = 0;
    uint32_t next = 0, acquired = 0, released = 0;
};

struct Runtime {
    std::mutex guard;
    std::condition_variable handed_over;
    Pretence pretence;
    int64_t pretended = 0;  // number of pictures that had been begun when the pretence was set
    Handed handed;
    int64_t begun = 0;
    int64_t begun_of_handed = 0;

    std::deque<XrSessionState> events;
    std::map<XrSwapchain, FakeSwapchain> swapchains;
    std::map<XrSpace, XrReferenceSpaceType> spaces;
    uintptr_t next_handle = 100;
    bool ended = false;
    std::chrono::steady_clock::time_point next_picture;

    Runtime() {
        for (int eye = 0; eye < 2; ++eye) {
            const float side = eye == 0 ? -1 : 1;
            pretence.eyes[eye] = {{{side * 0.0315f, 0.35f, 0.4f}, {-0.29f, 0, 0, 0.957f}},
                                  eye == 0 ? -0.8f : -0.7f,
                                  eye == 0 ? 0.7f : 0.8f,
                                  0.75f,
                                  -0.8f};
        }
        pretence.head = {{0, 0.35f, 0.4f}, {-0.29f, 0, 0, 0.957f}};
    }
};

Runtime& runtime() {
    static Runtime all;
    return all;
}

template <class Handle>
Handle new_handle() {
    return reinterpret_cast<Handle>(runtime().next_handle++);
}

XrPosef pose_of(const RuntimePose& X) {
    return {{X.R[0], X.R[1], X.R[2], X.R[3]}, {X.p[0], X.p[1], X.p[2]}};
}

RuntimePose pose_of(const XrPosef& X) {
    return {{X.position.x, X.position.y, X.position.z},
            {X.orientation.x, X.orientation.y, X.orientation.z, X.orientation.w}};
}

/// Answers a call that lists items: returns their number, and as many of them as there is room for.
template <class Item>
XrResult list(const std::vector<Item>& items, uint32_t room, uint32_t* count, Item* out) {
    *count = static_cast<uint32_t>(items.size());
    if (room == 0) return XR_SUCCESS;
    if (room < items.size()) return XR_ERROR_SIZE_INSUFFICIENT;
    for (size_t i = 0; i < items.size(); ++i) out[i] = items[i];
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL enumerate_extensions(const char*, uint32_t room, uint32_t* count,
                                                    XrExtensionProperties* out) {
    std::vector<XrExtensionProperties> all(
        2, made<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
    std::strcpy(all[0].extensionName, XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
    all[0].extensionVersion = XR_KHR_opengl_enable_SPEC_VERSION;
    std::strcpy(all[1].extensionName, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
    all[1].extensionVersion = XR_KHR_convert_timespec_time_SPEC_VERSION;
    return list(all, room, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo*, XrInstance* out) {
    *out = new_handle<XrInstance>();
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL destroy_instance(XrInstance) {
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL instance_properties(XrInstance, XrInstanceProperties* out) {
    out->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
    std::strcpy(out->runtimeName, "the tests' runtime");
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL result_to_string(XrInstance, XrResult value,
                                                char out[XR_MAX_RESULT_STRING_SIZE]) {
    std::snprintf(out, XR_MAX_RESULT_STRING_SIZE, "XrResult %d", value);
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL poll_event(XrInstance, XrEventDataBuffer* out) {
    Runtime& all = runtime();
    const std::lock_guard lock(all.guard);
    if (all.pretence.ends && !all.ended) {
        all.ended = true;
        all.events.push_back(XR_SESSION_STATE_STOPPING);
    }
    if (all.events.empty()) return XR_EVENT_UNAVAILABLE;
    auto changed = made<XrEventDataSessionStateChanged>(XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED);
    changed.state = all.events.front();
    all.events.pop_front();
    std::memcpy(out, &changed, sizeof changed);
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL get_system(XrInstance, const XrSystemGetInfo*, XrSystemId* out) {
    const std::lock_guard lock(runtime().guard);
    if (!runtime().pretence.has_headset) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
    *out = 1;
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL system_properties(XrInstance, XrSystemId, XrSystemProperties* out) {
    std::strcpy(out->systemName, "no headset");
    out->systemId = 1;
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL blend_modes(XrInstance, XrSystemId, XrViewConfigurationType,
                                           uint32_t room, uint32_t* count,
                                           XrEnvironmentBlendMode* out) {
    return list({XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, room, count, out);
}
XRAPI_ATTR XrResult XRAPI_CALL graphics_requirements(XrInstance, XrSystemId,
                                                     XrGraphicsRequirementsOpenGLKHR* out) {
    out->minApiVersionSupported = XR_MAKE_VERSION(3, 3, 0);
    out->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL create_session(XrInstance, const XrSessionCreateInfo* info,
                                              XrSession* out) {
    const auto* binding = static_cast<const XrGraphicsBindingOpenGLXlibKHR*>(info->next);
    if (binding == nullptr || binding->type != XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR ||
        binding->glxContext != glXGetCurrentContext())
        return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    const std::lock_guard lock(runtime().guard);
    runtime().events = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY};
    runtime().ended = false;
    *out = new_handle<XrSession>();
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL destroy_session(XrSession) {
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL begin_session(XrSession, const XrSessionBeginInfo*) {
    const std::lock_guard lock(runtime().guard);
    for (const XrSessionState state :
         {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED})
        runtime().events.push_back(state);
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL end_session(XrSession) {
    const std::lock_guard lock(runtime().guard);
    runtime().events = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_EXITING};
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL reference_spaces(XrSession, uint32_t room, uint32_t* count,
                                                XrReferenceSpaceType* out) {
    const std::lock_guard lock(runtime().guard);
    std::vector<XrReferenceSpaceType> all{XR_REFERENCE_SPACE_TYPE_VIEW,
                                          XR_REFERENCE_SPACE_TYPE_LOCAL};
    if (runtime().pretence.has_stage) all.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
    return list(all, room, count, out);
}
XRAPI_ATTR XrResult XRAPI_CALL create_space(XrSession, const XrReferenceSpaceCreateInfo* info,
                                            XrSpace* out) {
    *out = new_handle<XrSpace>();
    runtime().spaces[*out] = info->referenceSpaceType;
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL destroy_space(XrSpace space) {
    runtime().spaces.erase(space);
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL locate_space(XrSpace space, XrSpace base, XrTime,
                                            XrSpaceLocation* out) {
    const std::lock_guard lock(runtime().guard);
    if (runtime().spaces[space] != XR_REFERENCE_SPACE_TYPE_VIEW ||
        runtime().spaces[base] == XR_REFERENCE_SPACE_TYPE_VIEW)
        return XR_ERROR_VALIDATION_FAILURE;
    out->locationFlags = 0xf;
    out->pose = pose_of(runtime().pretence.head);
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL locate_views(XrSession, const XrViewLocateInfo*, XrViewState* state,
                                            uint32_t room, uint32_t* count, XrView* out) {
    *count = 2;
    if (room == 0) return XR_SUCCESS;
    const std::lock_guard lock(runtime().guard);
    const Pretence& pretence = runtime().pretence;
    state->viewStateFlags = (pretence.located ? 3u : 0u) | (pretence.tracked ? 12u : 0u);
    for (int eye = 0; eye < 2; ++eye) {
        out[eye].pose = pose_of(pretence.eyes[eye].pose);
        out[eye].fov = {pretence.eyes[eye].left, pretence.eyes[eye].right, pretence.eyes[eye].up,
                        pretence.eyes[eye].down};
    }
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL view_configurations(XrInstance, XrSystemId, XrViewConfigurationType,
                                                   uint32_t room, uint32_t* count,
                                                   XrViewConfigurationView* out) {
    auto view = made<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW);
    view.recommendedImageRectWidth = kWidth;
    view.recommendedImageRectHeight = kHeight;
    view.maxImageRectWidth = view.maxImageRectHeight = 4096;
    view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
    return list({view, view}, room, count, out);
}
XRAPI_ATTR XrResult XRAPI_CALL swapchain_formats(XrSession, uint32_t room, uint32_t* count,
                                                 int64_t* out) {
    return list<int64_t>({GL_RGBA16F, GL_SRGB8_ALPHA8, GL_RGBA8}, room, count, out);
}
XRAPI_ATTR XrResult XRAPI_CALL create_swapchain(XrSession, const XrSwapchainCreateInfo* info,
                                                XrSwapchain* out) {
    *out = new_handle<XrSwapchain>();
    FakeSwapchain& made = runtime().swapchains[*out];
    made.width = static_cast<int>(info->width);
    made.height = static_cast<int>(info->height);
    made.textures.resize(kImages);
    glGenTextures(kImages, made.textures.data());
    for (const GLuint texture : made.textures) {
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(info->format), made.width, made.height, 0,
                     GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    }
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL destroy_swapchain(XrSwapchain swapchain) {
    glDeleteTextures(kImages, runtime().swapchains[swapchain].textures.data());
    runtime().swapchains.erase(swapchain);
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL swapchain_images(XrSwapchain swapchain, uint32_t room,
                                                uint32_t* count, XrSwapchainImageBaseHeader* out) {
    std::vector<XrSwapchainImageOpenGLKHR> all;
    for (const GLuint texture : runtime().swapchains[swapchain].textures)
        all.push_back({XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, texture});
    return list(all, room, count, reinterpret_cast<XrSwapchainImageOpenGLKHR*>(out));
}
XRAPI_ATTR XrResult XRAPI_CALL acquire_image(XrSwapchain swapchain,
                                             const XrSwapchainImageAcquireInfo*, uint32_t* out) {
    FakeSwapchain& of = runtime().swapchains[swapchain];
    of.acquired = of.next++ % kImages;
    *out = of.acquired;
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL wait_image(XrSwapchain, const XrSwapchainImageWaitInfo*) {
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL release_image(XrSwapchain swapchain,
                                             const XrSwapchainImageReleaseInfo*) {
    FakeSwapchain& of = runtime().swapchains[swapchain];
    of.released = of.acquired;
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* out) {
    Runtime& all = runtime();
    const auto now = std::chrono::steady_clock::now();
    if (all.next_picture < now) all.next_picture = now;
    std::this_thread::sleep_until(all.next_picture);
    all.next_picture += kPeriod;
    const std::lock_guard lock(all.guard);
    ++all.begun;
    out->predictedDisplayTime =
        std::chrono::nanoseconds((all.next_picture + kPeriod).time_since_epoch()).count();
    out->predictedDisplayPeriod = std::chrono::nanoseconds(kPeriod).count();
    out->shouldRender = all.pretence.visible;
    return XR_SUCCESS;
}
XRAPI_ATTR XrResult XRAPI_CALL begin_frame(XrSession, const XrFrameBeginInfo*) {
    return XR_SUCCESS;
}

RuntimePicture read(const XrSwapchainSubImage& part) {
    const FakeSwapchain& from = runtime().swapchains[part.swapchain];
    RuntimePicture out;
    out.width = from.width;
    out.height = from.height;
    out.rgba.resize(size_t{4} * static_cast<size_t>(from.width) * static_cast<size_t>(from.height));
    glBindTexture(GL_TEXTURE_2D, from.textures[from.released]);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
    return out;
}

void write(const RuntimePicture& picture, const std::string& file) {
    if (picture.rgba.empty()) return;
    {
        std::ofstream out(file + ".part", std::ios::binary);
        out << "P6\n" << picture.width << " " << picture.height << "\n255\n";
        for (int y = picture.height - 1; y >= 0; --y) {
            for (int x = 0; x < picture.width; ++x) {
                const size_t at = 4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) +
                                       static_cast<size_t>(x));
                out.write(reinterpret_cast<const char*>(&picture.rgba[at]), 3);
            }
        }
    }
    std::rename((file + ".part").c_str(), file.c_str());
}

void write_some(const Handed& handed) {
    const char* const folder = std::getenv("DIHAPTIC_TEST_RUNTIME_PICTURES");
    if (folder == nullptr) return;
    if (std::ifstream(std::string(folder) + "/end").is_open()) runtime().pretence.ends = true;
    if (handed.count % 10 != 0) return;
    write(handed.eyes[0], std::string(folder) + "/left.ppm");
    write(handed.eyes[1], std::string(folder) + "/right.ppm");
    write(handed.words, std::string(folder) + "/words.ppm");
}

XRAPI_ATTR XrResult XRAPI_CALL end_frame(XrSession, const XrFrameEndInfo* info) {
    Runtime& all = runtime();
    const std::lock_guard lock(all.guard);
    Handed& handed = all.handed;
    ++handed.count;
    handed.layers = static_cast<int>(info->layerCount);
    handed.time = info->displayTime;
    handed.words = {};
    for (uint32_t i = 0; i < info->layerCount; ++i) {
        const XrCompositionLayerBaseHeader* const layer = info->layers[i];
        if (layer->type == XR_TYPE_COMPOSITION_LAYER_PROJECTION) {
            const auto* views = reinterpret_cast<const XrCompositionLayerProjection*>(layer)->views;
            for (int eye = 0; eye < 2; ++eye) {
                handed.eyes[eye] = read(views[eye].subImage);
                const XrFovf& fov = views[eye].fov;
                handed.eyes[eye].eye = {pose_of(views[eye].pose), fov.angleLeft, fov.angleRight,
                                        fov.angleUp, fov.angleDown};
            }
        } else if (layer->type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
            const auto* quad = reinterpret_cast<const XrCompositionLayerQuad*>(layer);
            handed.words = read(quad->subImage);
            handed.words_pose = pose_of(quad->pose);
        }
    }
    write_some(handed);
    all.begun_of_handed = all.begun;
    all.handed_over.notify_all();
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL to_timespec(XrInstance, XrTime time, timespec* out) {
    out->tv_sec = time / 1000000000;
    out->tv_nsec = time % 1000000000;
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL proc_address(XrInstance, const char* name, PFN_xrVoidFunction* out) {
#define ENTRY(xr_name, function) \
    { xr_name, reinterpret_cast<PFN_xrVoidFunction>(function) }
    static const std::map<std::string, PFN_xrVoidFunction> all{
        ENTRY("xrGetInstanceProcAddr", proc_address),
        ENTRY("xrEnumerateInstanceExtensionProperties", enumerate_extensions),
        ENTRY("xrCreateInstance", create_instance),
        ENTRY("xrDestroyInstance", destroy_instance),
        ENTRY("xrGetInstanceProperties", instance_properties),
        ENTRY("xrResultToString", result_to_string),
        ENTRY("xrPollEvent", poll_event),
        ENTRY("xrGetSystem", get_system),
        ENTRY("xrGetSystemProperties", system_properties),
        ENTRY("xrEnumerateEnvironmentBlendModes", blend_modes),
        ENTRY("xrGetOpenGLGraphicsRequirementsKHR", graphics_requirements),
        ENTRY("xrCreateSession", create_session),
        ENTRY("xrDestroySession", destroy_session),
        ENTRY("xrBeginSession", begin_session),
        ENTRY("xrEndSession", end_session),
        ENTRY("xrEnumerateReferenceSpaces", reference_spaces),
        ENTRY("xrCreateReferenceSpace", create_space),
        ENTRY("xrDestroySpace", destroy_space),
        ENTRY("xrLocateSpace", locate_space),
        ENTRY("xrLocateViews", locate_views),
        ENTRY("xrEnumerateViewConfigurationViews", view_configurations),
        ENTRY("xrEnumerateSwapchainFormats", swapchain_formats),
        ENTRY("xrCreateSwapchain", create_swapchain),
        ENTRY("xrDestroySwapchain", destroy_swapchain),
        ENTRY("xrEnumerateSwapchainImages", swapchain_images),
        ENTRY("xrAcquireSwapchainImage", acquire_image),
        ENTRY("xrWaitSwapchainImage", wait_image),
        ENTRY("xrReleaseSwapchainImage", release_image),
        ENTRY("xrWaitFrame", wait_frame),
        ENTRY("xrBeginFrame", begin_frame),
        ENTRY("xrEndFrame", end_frame),
        ENTRY("xrConvertTimeToTimespecTimeKHR", to_timespec),
    };
#undef ENTRY
    const auto found = all.find(name);
    *out = found == all.end() ? nullptr : found->second;
    return found == all.end() ? XR_ERROR_FUNCTION_UNSUPPORTED : XR_SUCCESS;
}

// What the loader and a runtime agree on, as defined in the loader's own specification.
struct LoaderInfo {
    int type;
    uint32_t version;
    size_t size;
    uint32_t least_interface, most_interface;
    XrVersion least_api, most_api;
};
struct RuntimeRequest {
    int type;
    uint32_t version;
    size_t size;
    uint32_t interface;
    XrVersion api;
    PFN_xrGetInstanceProcAddr proc_address;
};

}  // namespace

extern "C" {

__attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const LoaderInfo* info, RuntimeRequest* request) {
    if (info->least_interface > 1 || info->most_interface < 1)
        return XR_ERROR_INITIALIZATION_FAILED;
    request->interface = 1;
    request->api = XR_MAKE_VERSION(1, 0, 0);
    request->proc_address = proc_address;
    return XR_SUCCESS;
}

__attribute__((visibility("default"))) void dihaptic_pretend(const Pretence& pretence) {
    const std::lock_guard lock(runtime().guard);
    runtime().pretence = pretence;
    runtime().pretended = runtime().begun;
}

__attribute__((visibility("default"))) bool dihaptic_wait_for_picture(Handed& out) {
    Runtime& all = runtime();
    std::unique_lock lock(all.guard);
    const bool came = all.handed_over.wait_for(lock, kPatience,
                                               [&] { return all.begun_of_handed > all.pretended; });
    if (came) out = all.handed;
    return came;
}
}
