#include "fake_hd.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "devices/openhaptics/hd.h"
#include "devices/test/felt_outside.h"
#include "model/phantom_arm.h"

namespace dihaptic::devices::openhaptics {
namespace {

using Device = FakeHd::Device;

FakeHd fake;

struct Scheduled {
    unsigned long handle;
    HdCallback callback;
    void* data;
    unsigned short priority;
};

/// A single lock protects all data, because speed does not matter here.
std::recursive_mutex mutex;
std::deque<HdErrorInfo> errors;
HdHandle current = kNoHandle;
unsigned long rate = 1000;
std::vector<Scheduled> scheduled;
unsigned long handles = 0;
std::atomic<bool> running{false};
std::chrono::steady_clock::time_point begun;
std::thread scheduler;
std::atomic<std::thread::id> scheduler_id;
std::vector<int> frames_of_tick;  // by device
std::vector<bool> framed;         // by device
Wrench wanted[8];                 // commanded in this frame, indexed by device

using Lock = std::lock_guard<std::recursive_mutex>;

FeltOutside& outside() {
    static FeltOutside one;
    return one;
}

/// Makes a device push with a force, and shows that force outside the process.
void act(Device& device, const Wrench& push, bool told = false) {
    device.acting = push.force;
    device.acting_torque = push.torque;
    outside().show(static_cast<size_t>(&device - fake.devices.data()), push.force, told);
}

void push(unsigned code, HdHandle device) {
    errors.push_front({code, 0, device});
}

Device* find(HdHandle handle) {
    if (handle < fake.devices.size() && fake.devices[handle].initialised)
        return &fake.devices[handle];
    push(kHdBadHandle, handle);
    return nullptr;
}

void raise(unsigned code, size_t device) {
    const Lock lock(mutex);
    push(code, static_cast<HdHandle>(device));
    if (code < kHdWarmMotors || code > kHdForceError) return;
    act(fake.devices[device], {});
    fake.devices[device].frames_of_force = 0;
}

void stop() {
    running.store(false);
    if (scheduler.joinable()) scheduler.join();
}

void reset() {
    stop();
    const Lock lock(mutex);
    fake = {};
    fake.devices.resize(2);
    fake.devices[0].name = "PHANToM 1";
    fake.devices[0].serial = "40123";
    fake.devices[1].name = "PHANToM 2";
    fake.devices[1].serial = "40124";
    fake.raise = raise;
    fake.reset = reset;
    fake.hand = pushing_hand();
    errors.clear();
    scheduled.clear();
    current = kNoHandle;
    rate = 1000;
    frames_of_tick.assign(8, 0);
    framed.assign(8, false);
}

/// Checks that, while the scheduler runs, only its callbacks call a device's functions.
void look_at_thread() {
    if (running.load() && std::this_thread::get_id() != scheduler_id) ++fake.violations;
}

bool call_all() {
    std::vector<Scheduled> now;
    {
        const Lock lock(mutex);
        std::fill(frames_of_tick.begin(), frames_of_tick.end(), 0);
        now = scheduled;
    }
    for (const Scheduled& one : now) {
        if (one.callback(one.data) == kHdContinue) continue;
        const Lock lock(mutex);
        std::erase_if(scheduled, [&](const Scheduled& s) { return s.handle == one.handle; });
        fake.callbacks_left = static_cast<int>(scheduled.size());
    }
    return !now.empty();
}

void run_scheduler() {
    using Clock = std::chrono::steady_clock;
    scheduler_id = std::this_thread::get_id();
    const auto period = std::chrono::nanoseconds(1000000000L / static_cast<long>(rate));
    auto next = Clock::now();
    bool silent = false;
    for (int tick = 0; running.load(); ++tick) {
        silent = silent || fake.silent || (fake.before_tick && !fake.before_tick(tick));
        const bool called = !silent && call_all();
        do {
            next += period;  // ticks that were missed are skipped
        } while (next < Clock::now());
        if (fake.real_time) {
            std::this_thread::sleep_until(next);
        } else if (!called) {
            std::this_thread::sleep_for(period);
        }
    }
}

/// Returns the current device, to which the call applies. If there is none, raises an error and
/// returns null.
Device* here() {
    look_at_thread();
    return find(current);
}

Held held(Device& device) {
    const auto i = static_cast<size_t>(&device - fake.devices.data());
    double t = static_cast<double>(device.frames) / static_cast<double>(rate);
    if (fake.real_time)
        t = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    Held out = fake.hand ? fake.hand(i, t, {device.acting, device.acting_torque}) : Held{};
    ++device.frames;
    return out;
}
Held state[8];  // states in this frame, indexed by device

/// The joint angles that an arm's encoders report, in Dihaptic's sign convention [rad].
Vec3 told_joints(const Device& device, const Held& now) {
    return model::phantom_joints({}, now.p) - *device.joint_offset;
}

Vec3 middle(const Device& device) {
    const double* const w = device.workspace;
    return Vec3(w[0] + w[3], w[1] + w[4], w[2] + w[5]) / 2;
}

/// The position of the handle as HD reports it [mm].
Vec3 told_position(const Device& device, const Held& now) {
    if (device.joint_offset) return 1e3 * model::phantom_position({}, told_joints(device, now));
    return 1e3 * now.p + middle(device);
}

/// The part of a force that reaches the hand, because force ramps up after the amplifiers are
/// switched on.
Wrench ramped(Device& device, const Wrench& push) {
    const double most = fake.ramp * ++device.frames_of_force / static_cast<double>(rate);
    const double size = push.force.norm();
    if (!device.ramping || size <= most) return push;
    return {push.force * (most / size), push.torque * (most / size)};
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming,clang-diagnostic-return-type-c-linkage): the
// manufacturer's
extern "C" {

FakeHd* dihaptic_fake_hd() {
    if (!fake.reset) fake.reset = reset;
    return &fake;
}

HdHandle hdInitDevice(const char* name) {
    const Lock lock(mutex);
    if (!fake.reset) reset();
    if (fake.init_error != 0) {
        push(std::exchange(fake.init_error, 0u), kNoHandle);
        return kNoHandle;
    }
    for (size_t i = 0; i < fake.devices.size(); ++i) {
        Device& device = fake.devices[i];
        if (name != nullptr && device.name != name) continue;
        if (device.initialised) {
            push(kHdAlreadyInitiated, static_cast<HdHandle>(i));
            return kNoHandle;
        }
        device.initialised = true;
        outside().note_opened(i);
        ++device.opened;
        device.late = running.load();
        device.force_enabled = device.ramping = false;
        device.frames = device.frames_of_force = 0;
        act(device, {});
        current = static_cast<HdHandle>(i);
        return current;
    }
    push(kHdBadHandle, kNoHandle);
    return kNoHandle;
}

void hdDisableDevice(HdHandle handle) {
    const Lock lock(mutex);
    Device* const device = find(handle);
    if (device == nullptr) return;
    if (running.load()) ++fake.violations;
    device->initialised = false;
    device->force_enabled = false;
    act(*device, {});
}

void hdMakeCurrentDevice(HdHandle handle) {
    const Lock lock(mutex);
    look_at_thread();
    if (find(handle) != nullptr) current = handle;
}

void hdBeginFrame(HdHandle handle) {
    if (fake.in_frame) fake.in_frame(handle);
    fail_as_asked();
    const Lock lock(mutex);
    look_at_thread();
    Device* const device = find(handle);
    if (device == nullptr || device->late) return;
    current = handle;
    if (framed[handle]) return push(kHdIllegalBegin, handle);
    if (running.load() && frames_of_tick[handle]++ > 0) return push(kHdFrameError, handle);
    framed[handle] = true;
    wanted[handle] = {};
    state[handle] = held(*device);
}

void hdEndFrame(HdHandle handle) {
    const Lock lock(mutex);
    look_at_thread();
    Device* const device = find(handle);
    if (device == nullptr || device->late) return;
    if (!framed[handle]) return push(kHdIllegalEnd, handle);
    framed[handle] = false;
    const auto bears = [](const Vec3& v, double most) { return v.norm() <= most * (1 + 1e-9); };
    const Wrench& push = wanted[handle];
    const bool turns = device->max_torque >= 0;
    if (!bears(push.force, device->max_force) ||
        (turns && !bears(push.torque * 1e3, device->max_torque))) {
        raise(kHdExceededMaxForce, handle);
        return;
    }
    const bool on = device->force_enabled && running.load();
    if (!on) device->frames_of_force = 0;
    act(*device, on ? ramped(*device, push) : Wrench{}, true);
}

HdErrorInfo hdGetError() {
    const Lock lock(mutex);
    if (errors.empty()) return {};
    const HdErrorInfo newest = errors.front();
    errors.pop_front();
    return newest;
}

void hdEnable(unsigned capability) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return;
    if (capability == kHdForceOutput) device->force_enabled = true;
    if (capability == kHdForceRamping) device->ramping = true;
}

void hdDisable(unsigned capability) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return;
    if (capability == kHdForceOutput) device->force_enabled = false;
    if (capability == kHdForceRamping) device->ramping = false;
}

unsigned char hdIsEnabled(unsigned capability) {
    const Lock lock(mutex);
    Device* const device = here();
    return device != nullptr && capability == kHdForceOutput && device->force_enabled ? 1 : 0;
}

void hdGetIntegerv(unsigned value, int* out) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return;
    if (value == kHdButtons) *out = 0;
    if (value == kHdInputDof) *out = device->input_dof;
    if (value == kHdOutputDof) *out = device->output_dof;
    if (value == kHdCalibrationStyle) *out = static_cast<int>(device->style);
}

void hdGetDoublev(unsigned value, double* out) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return;
    const Held& now = state[current];
    const auto give = [&](const Vec3& v) { std::copy_n(v.data(), 3, out); };
    switch (value) {
        case kHdPosition:
            give(device->nonsense ? Vec3::Constant(std::nan("")) : told_position(*device, now));
            break;
        case kHdJointAngles: {
            if (!device->joint_offset) return push(0x100, current);
            const Vec3 q = told_joints(*device, now);
            give({-q[0], q[1], q[2]});
            break;
        }
        case kHdVelocity:
            give(now.v * 1e3);
            break;
        case kHdAngularVelocity:
            give(now.w);
            break;
        case kHdTransform: {
            Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
            transform.topLeftCorner<3, 3>() = now.R.toRotationMatrix();
            transform.topRightCorner<3, 1>() = told_position(*device, now);
            std::copy_n(transform.data(), 16, out);
            break;
        }
        case kHdUsableWorkspace:
            std::copy_n(device->workspace, 6, out);
            break;
        case kHdMaxForce:
            *out = device->max_force;
            break;
        case kHdMaxContinuousForce:
            *out = device->continuous_force;
            break;
        case kHdMaxTorque:
        case kHdMaxContinuousTorque: {
            const bool peak = value == kHdMaxTorque;
            const double told = peak ? device->max_torque : device->continuous_torque;
            if (told < 0) return push(0x100, current);
            *out = told;
            break;
        }
        case kHdMaxStiffness:
            *out = device->max_stiffness;
            break;
        case kHdMaxDamping:
            *out = device->max_damping;
            break;
        default:
            push(0x100, current);
    }
}

void hdSetDoublev(unsigned value, const double* in) {
    const Lock lock(mutex);
    if (here() == nullptr) return;
    const bool turn = value == kHdTorque && fake.devices[current].output_dof >= 6;
    if (value != kHdForce && !turn) return push(0x100, current);
    // outside a frame, setting a force is a mistake and has no effect
    if (!framed[current]) ++fake.violations;
    if (turn) wanted[current].torque = Vec3(in[0], in[1], in[2]) * 1e-3;
    if (!turn) wanted[current].force = Vec3(in[0], in[1], in[2]);
}

const char* hdGetString(unsigned value) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return nullptr;
    if (value == kHdModel) return device->model.c_str();
    if (value == kHdSerial) return device->serial.c_str();
    if (value == kHdVersion) return "3.4";
    push(0x100, current);
    return nullptr;
}

unsigned hdCheckCalibration() {
    const Lock lock(mutex);
    Device* const device = here();
    return device == nullptr ? unsigned{kHdNeedsHand} : device->calibration;
}

void hdUpdateCalibration(unsigned style) {
    const Lock lock(mutex);
    Device* const device = here();
    if (device == nullptr) return;
    if ((device->style & style) == 0) return push(kHdInvalidValue, current);
    if (style == kHdEncoderReset && running.load()) ++fake.violations;
    if (style == kHdEncoderReset) ++device->resets;
    device->calibration = device->updated;
}

void hdSetSchedulerRate(unsigned long hz) {
    const Lock lock(mutex);
    if (std::find(fake.rates.begin(), fake.rates.end(), hz) == fake.rates.end())
        return push(kHdInvalidValue, current);
    rate = hz;
}

void hdStartScheduler() {
    const Lock lock(mutex);
    if (running.load()) return push(kHdInvalidOperation, kNoHandle);
    for (Device& device : fake.devices) {
        device.late = false;
        device.frames_of_force = 0;
    }
    running.store(true);
    begun = std::chrono::steady_clock::now();
    scheduler = std::thread(run_scheduler);
}

void hdStopScheduler() {
    stop();
    const Lock lock(mutex);
    for (Device& device : fake.devices) act(device, {});
    framed.assign(framed.size(), false);
}

unsigned long hdScheduleAsynchronous(HdCallback callback, void* data, unsigned short priority) {
    const Lock lock(mutex);
    scheduled.push_back({++handles, callback, data, priority});
    std::stable_sort(scheduled.begin(), scheduled.end(),
                     [](const auto& a, const auto& b) { return a.priority > b.priority; });
    fake.callbacks_left = static_cast<int>(scheduled.size());
    return handles;
}

void hdUnschedule(unsigned long handle) {
    const Lock lock(mutex);
    const auto removed =
        std::erase_if(scheduled, [&](const Scheduled& s) { return s.handle == handle; });
    if (removed == 0) push(kHdInvalidOperation, kNoHandle);
    fake.callbacks_left = static_cast<int>(scheduled.size());
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming,clang-diagnostic-return-type-c-linkage)
}  // namespace dihaptic::devices::openhaptics
