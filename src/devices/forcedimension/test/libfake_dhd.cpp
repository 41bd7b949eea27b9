#include "fake_dhd.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "devices/forcedimension/dhd.h"
#include "devices/test/felt_outside.h"

namespace dihaptic::devices::forcedimension {
namespace {

using Device = FakeDhd::Device;

FakeDhd fake;
std::recursive_mutex mutex;
thread_local const char* last_error = "no error";
using Lock = std::lock_guard<std::recursive_mutex>;

FeltOutside& outside() {
    static FeltOutside one;
    return one;
}

/// Makes a device push with a force, and shows that force outside the process.
void act(size_t i, const Wrench& push, bool told = false) {
    fake.devices[i].acting = push.force;
    fake.devices[i].acting_torque = push.torque;
    outside().show(i, push.force, told);
}

/// The time on the device's clock [s].
double now(const Device& device) {
    static const bool real = std::getenv("DIHAPTIC_FAKE_PUSH") != nullptr;
    static const auto begin = std::chrono::steady_clock::now();
    if (!real) return device.frames * fake.period;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

int fail(const char* why) {
    last_error = why;
    return -1;
}

void cut(size_t i, int cause) {
    const Lock lock(mutex);
    Device& device = fake.devices[i];
    device.force_enabled = false;
    device.cause = cause;
    act(i, {});
}

/// Simulates the watchdog in a device's firmware: if it is set, it ends a force that is not
/// renewed.
void watch(size_t i) {
    const Device& device = fake.devices[i];
    const double limit = device.watchdog * kDhdWatchdogStep;
    if (device.watchdog > 0 && device.force_enabled && now(device) - device.told_at > limit)
        cut(i, kDhdByWatchdog);
}

void reset() {
    const Lock lock(mutex);
    fake = {};
    fake.devices.resize(2);
    fake.devices[0].serial = 101;
    fake.devices[1].serial = 102;
    fake.cut = cut;
    fake.reset = reset;
    fake.hand = pushing_hand();
}

Device* find(char id) {
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size() || !fake.devices[i].open) {
        fail("the device is not open");
        return nullptr;
    }
    watch(i);
    if (fake.devices[i].silent) {
        fail("communication error");
        return nullptr;
    }
    return &fake.devices[i];
}

Held state[8];  // states at the last reading, indexed by device

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the manufacturer's names
extern "C" {

FakeDhd* dihaptic_fake_dhd() {
    if (!fake.reset) fake.reset = reset;
    return &fake;
}

int dhdGetDeviceCount() {
    const Lock lock(mutex);
    if (!fake.reset) reset();
    return static_cast<int>(fake.devices.size());
}

int dhdOpenID(char id) {
    const Lock lock(mutex);
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size()) return fail("no device found");
    Device& device = fake.devices[i];
    if (device.in_use || device.open) return fail("the device is in use");
    device.open = true;
    outside().note_opened(i);
    ++device.opened;
    device.force_enabled = device.gravity = false;
    device.frames = 0;
    device.wanted.setZero();
    act(i, {});
    return id;
}

int dhdClose(char id) {
    const Lock lock(mutex);
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size() || !fake.devices[i].open) return fail("not open");
    fake.devices[i].open = false;
    act(i, {});
    return 0;
}

const char* dhdGetSystemName(char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    return device == nullptr ? nullptr : device->model.c_str();
}

int dhdGetSerialNumber(unsigned short* serial, char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    if (device == nullptr) return -1;
    *serial = device->serial;
    return 0;
}

int dhdEnableForce(unsigned char on, char id) {
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    if (on == 0) {
        cut(static_cast<unsigned char>(id), kDhdBySoftware);
    } else {
        device->force_enabled = true;
        device->cause = 0;
        device->told_at = now(*device);
    }
    return 0;
}

int dhdGetPosition(double* x, double* y, double* z, char id) {
    const auto i = static_cast<unsigned char>(id);
    if (fake.in_position) fake.in_position(i);
    fail_as_asked();
    const Lock lock(mutex);
    Device* const device = find(id);
    const double t = i < fake.devices.size() ? now(fake.devices[i]) : 0;
    if (i < fake.devices.size()) ++fake.devices[i].frames;  // time advances even if the call fails
    if (device == nullptr) return -1;
    state[i] = fake.hand ? fake.hand(i, t, {device->acting, device->acting_torque}) : Held{};
    if (device->fastest > 0 && state[i].v.norm() > device->fastest) cut(i, kDhdByVelocity);
    const Vec3 p = device->nonsense ? Vec3::Constant(std::nan("")) : state[i].p;
    *x = p.x();
    *y = p.y();
    *z = p.z();
    return device->time_guard ? 1 : 0;
}

int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
    const Lock lock(mutex);
    if (find(id) == nullptr) return -1;
    const Vec3& v = state[static_cast<unsigned char>(id)].v;
    *x = v.x();
    *y = v.y();
    *z = v.z();
    return 0;
}

int dhdSetForceAndTorque(double x, double y, double z, double a, double b, double c, char id) {
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    device->wanted = Vec3(x, y, z);
    device->told_at = now(*device);
    Wrench push;
    if (device->force_enabled) push = {device->wanted, Vec3(a, b, c)};
    if (!device->active_wrist) push.torque.setZero();
    bool saturated = false;
    const auto cap = [&](Vec3& v, double most) {
        if (most < 0 || v.norm() <= most * (1 + 1e-9)) return;
        saturated = true;
        v *= most / v.norm();
    };
    cap(push.force, device->max_force);
    cap(push.torque, device->max_torque);
    act(static_cast<unsigned char>(id), push, true);
    return saturated ? 2 : 0;
}

int dhdSetForce(double x, double y, double z, char id) {
    return dhdSetForceAndTorque(x, y, z, 0, 0, 0, id);
}

bool dhdHasWrist(char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    return device != nullptr && device->wrist;
}

bool dhdHasActiveWrist(char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    return device != nullptr && device->active_wrist;
}

int dhdGetOrientationFrame(double (*matrix)[3], char id) {
    const Lock lock(mutex);
    if (find(id) == nullptr) return -1;
    const Mat3 R = state[static_cast<unsigned char>(id)].R.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) matrix[row][column] = R(row, column);
    }
    return 0;
}

int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id) {
    const Lock lock(mutex);
    if (find(id) == nullptr) return -1;
    const Vec3& w = state[static_cast<unsigned char>(id)].w;
    *x = w.x();
    *y = w.y();
    *z = w.z();
    return 0;
}

int dhdEnableExpertMode() {
    fake.expert = true;
    return 0;
}

int dhdDisableExpertMode() {
    fake.expert = false;
    return 0;
}

int dhdSetWatchdog(unsigned char steps, char id) {
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    if (!fake.expert) return fail("expert mode is disabled");
    if (!device->has_watchdog) return fail("not available on this device");
    device->watchdog = steps;
    device->told_at = now(*device);
    outside().set_watchdog(static_cast<unsigned char>(id), steps * kDhdWatchdogStep);
    return 0;
}

unsigned dhdGetButtonMask(char) {
    return 0;
}

int dhdSetGravityCompensation(int on, char id) {
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    device->gravity = on != 0;
    return 0;
}

double dhdGetMaxForce(char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    return device == nullptr ? -1 : device->max_force;
}

double dhdGetMaxTorque(char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    return device == nullptr ? -1 : device->max_torque;
}

int dhdGetStatus(int* out, char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    if (device == nullptr) return -1;
    std::fill_n(out, 17, 0);
    out[kDhdPower] = device->power ? 1 : 0;
    out[kDhdConnected] = device->connected ? 1 : 0;
    out[kDhdReset] = device->calibrated ? 0 : 1;
    out[kDhdForce] = device->force_enabled ? 1 : 0;
    out[kDhdBrake] = device->force_enabled ? 0 : 1;
    out[kDhdErrorIndex] = device->broken ? 1 : 0;
    out[kDhdForceOffCause] = device->force_enabled ? 0 : device->cause;
    return 0;
}

const char* dhdErrorGetLastStr() {
    return last_error;
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
}  // namespace dihaptic::devices::forcedimension
