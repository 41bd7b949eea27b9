#include "fake_dhd.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "devices/forcedimension/dhd.h"

namespace dihaptic::devices::forcedimension {
namespace {

using Device = FakeDhd::Device;

FakeDhd fake;
std::recursive_mutex mutex;
thread_local const char* last_error = "no error";
using Lock = std::lock_guard<std::recursive_mutex>;

int fail(const char* why) {
    last_error = why;
    return -1;
}

void cut(size_t i, int cause) {
    const Lock lock(mutex);
    Device& device = fake.devices[i];
    device.force_enabled = false;
    device.cause = cause;
    device.acting.setZero();
}

void reset() {
    const Lock lock(mutex);
    fake = {};
    fake.devices.resize(2);
    fake.devices[0].serial = 101;
    fake.devices[1].serial = 102;
    fake.cut = cut;
    fake.reset = reset;
}

Device* find(char id) {
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size() || !fake.devices[i].open) {
        fail("the device is not open");
        return nullptr;
    }
    if (fake.devices[i].silent) {
        fake.devices[i].acting.setZero();  // its firmware's watchdog
        fail("communication error");
        return nullptr;
    }
    return &fake.devices[i];
}

Held state[8];  // by device, as last read

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the maker's names
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

int dhdGetAvailableCount() {
    const Lock lock(mutex);
    return static_cast<int>(std::count_if(fake.devices.begin(), fake.devices.end(),
                                          [](const Device& d) { return !d.in_use && !d.open; }));
}

int dhdOpenID(char id) {
    const Lock lock(mutex);
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size()) return fail("no device found");
    Device& device = fake.devices[i];
    if (device.in_use || device.open) return fail("the device is in use");
    device.open = true;
    device.force_enabled = device.gravity = false;
    device.frames = 0;
    device.wanted.setZero();
    device.acting.setZero();
    return id;
}

int dhdClose(char id) {
    const Lock lock(mutex);
    const auto i = static_cast<unsigned char>(id);
    if (id < 0 || i >= fake.devices.size() || !fake.devices[i].open) return fail("not open");
    fake.devices[i].open = false;
    fake.devices[i].acting.setZero();
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
    }
    return 0;
}

int dhdGetPosition(double* x, double* y, double* z, char id) {
    const auto i = static_cast<unsigned char>(id);
    if (fake.in_position) fake.in_position(i);
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    const double t = device->frames++ * fake.period;
    state[i] = fake.hand ? fake.hand(i, t, device->acting) : Held{};
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

int dhdSetForce(double x, double y, double z, char id) {
    const Lock lock(mutex);
    Device* const device = find(id);
    if (device == nullptr) return -1;
    device->wanted = Vec3(x, y, z);
    device->acting = device->force_enabled ? device->wanted : Vec3::Zero();
    const double most = device->max_force;
    if (most <= 0 || !(device->acting.norm() > most)) return 0;
    device->acting *= most / device->acting.norm();
    return 2;
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

int dhdGetStatus(int* out, char id) {
    const Lock lock(mutex);
    const Device* const device = find(id);
    if (device == nullptr) return -1;
    std::fill_n(out, DhdStatus{}.size(), 0);
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
