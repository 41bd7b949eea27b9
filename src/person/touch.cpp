#include "person/touch.h"

#include <algorithm>

namespace dihaptic::person {
namespace {

constexpr double kLeastForce = 0.03;        // smallest force that is felt [N]
constexpr double kSlipSpeed = 1e-3;         // speed below which sliding is ignored [m/s]
constexpr double kSlipDistance = 1e-4;      // shortest slip that is felt [m]
constexpr double kPad = 0.01;               // size of a fingertip pad [m]
constexpr double kAccelerationTime = 0.02;  // time constant for smoothing accelerations [s]

/// The contact in which the proxy of `finger` presses hardest on a body of the scene; null if it
/// presses on no body.
const frame::ContactFrame* hardest(const frame::Frame& frame, size_t finger) noexcept {
    const auto bodies = static_cast<int>(frame.bodies.size());
    const int proxy = bodies + static_cast<int>(finger);
    const frame::ContactFrame* out = nullptr;
    for (const frame::ContactFrame& contact : frame.contacts) {
        const int other = contact.a == proxy ? contact.b : contact.b == proxy ? contact.a : -1;
        if (other < 0 || other >= bodies || contact.normal_force <= kLeastForce) continue;
        if (out == nullptr || contact.normal_force > out->normal_force) out = &contact;
    }
    return out;
}

}  // namespace

Touch::Touch(size_t first, std::vector<Vec3> sides, std::vector<double> frictions, double tick)
    : first_(first),
      sides_(std::move(sides)),
      frictions_(std::move(frictions)),
      tick_(tick),
      slid_(sides_.size(), 0) {}

void Touch::restart() noexcept {
    std::fill(slid_.begin(), slid_.end(), 0);
    a_WH_ = v_WH_ = Vec3::Zero();
    started_ = false;
}

Feeling Touch::feel(const frame::Frame& frame) noexcept {
    Feeling out;
    const auto count = static_cast<double>(sides_.size());
    Vec3 v_WH = Vec3::Zero();
    int pressing = 0;
    for (size_t i = 0; i < sides_.size(); ++i) {
        const frame::FingerFrame& finger = frame.fingers[first_ + i];
        v_WH += finger.v_WH / count;
        out.rise += finger.v_WP.z() / count;
        out.force_W -= finger.f_sent_W;
        const double inward = finger.f_sent_W.dot(sides_[i]);
        out.grip += inward / count;
        if (inward > kLeastForce) ++pressing;

        const frame::ContactFrame* contact = hardest(frame, first_ + i);
        if (contact == nullptr) {
            slid_[i] = 0;
            continue;
        }
        const auto bodies = static_cast<int>(frame.bodies.size());
        out.body = contact->a < bodies ? contact->a : contact->b;
        const frame::BodyFrame& body = frame.bodies[static_cast<size_t>(out.body)];
        const Vec3 v_WC = body.v_WB + body.w_WB.cross(contact->p_WC - body.X_WB.p);
        const Vec3 n_W = contact->n_W.normalized();
        Vec3 slip = finger.v_WP - v_WC;
        slip -= slip.dot(n_W) * n_W;
        slid_[i] = slip.norm() > kSlipSpeed ? slid_[i] + slip.norm() * tick_ : 0;
        if (slid_[i] > kSlipDistance) {
            out.slips = true;
            const double normal = std::abs(contact->f_B_W.dot(n_W));
            const double across = (contact->f_B_W - contact->f_B_W.dot(n_W) * n_W).norm();
            // a body that turns under the finger also slips, but that does not reveal its friction
            const bool turns = body.w_WB.norm() * kPad > slip.norm() / 2;
            out.slip_friction = normal > 0 && !turns ? across / normal : 0;
        }
    }
    out.held = pressing >= 2;
    if (out.body >= 0) {
        out.friction = frictions_[static_cast<size_t>(out.body)];
        for (const frame::PropertiesFrame& properties : frame.task.properties) {
            if (properties.body == out.body) out.friction *= properties.friction_scale;
        }
    }
    if (started_)
        a_WH_ += ((v_WH - v_WH_) / tick_ - a_WH_) * std::min(1.0, tick_ / kAccelerationTime);
    v_WH_ = v_WH;
    started_ = true;
    out.acceleration_W = a_WH_;
    return out;
}

}  // namespace dihaptic::person
