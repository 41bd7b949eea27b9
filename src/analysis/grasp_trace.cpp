#include "analysis/grasp_trace.h"

#include <algorithm>
#include <cmath>

#include "model/butterworth.h"
#include "model/grasp.h"

namespace dihaptic::analysis {

namespace {

constexpr size_t kUsualSamples = 16384;  ///< of a trial

Vec3 axis_of(const GraspTrace::Sample& sample) {
    return model::grasp_axis(sample.p_WP.size(), [&](size_t i) { return sample.p_WP[i]; });
}

Vec3 velocity_at(const frame::BodyFrame& body, const Vec3& p_W) {
    return body.v_WB + body.w_WB.cross(p_W - body.X_WB.p);
}

/// Adds the object's contacts with fingers and with supports to the sample.
void add_contacts(GraspTrace::Sample& sample, const frame::Frame& frame, int object) {
    const int first_proxy = static_cast<int>(frame.bodies.size());
    const auto body = [&](int i) -> const frame::BodyFrame& {
        return frame.bodies[static_cast<size_t>(i)];
    };
    double pressed = 0;
    for (const frame::ContactFrame& contact : frame.contacts) {
        if (contact.normal_force <= 0 || (contact.a != object && contact.b != object)) continue;
        const int other = contact.a == object ? contact.b : contact.a;
        if (other < first_proxy) {
            sample.on_support = true;
            if (contact.normal_force <= pressed) continue;
            pressed = contact.normal_force;
            sample.support = other;
            sample.n_support = (contact.a == object ? -1 : 1) * contact.n_W.normalized();
            const Vec3 v =
                velocity_at(body(object), contact.p_WC) - velocity_at(body(other), contact.p_WC);
            sample.v_sliding = v - v.dot(sample.n_support) * sample.n_support;
        } else {
            const auto finger = static_cast<size_t>(other - first_proxy);
            sample.touching[finger] = true;
            sample.normal_force[finger] += contact.normal_force;
            const Vec3 f_W = contact.b == other ? contact.f_B_W : Vec3(-contact.f_B_W);
            sample.f_tangential_W[finger] += f_W - f_W.dot(contact.n_W) * contact.n_W;
        }
    }
}

/// Adds the factors on the properties of the object and of its support, which must be known.
void add_properties(GraspTrace::Sample& sample, const frame::Frame& frame, int object) {
    sample.friction_scale = frame.friction_scale;
    for (const frame::PropertiesFrame& properties : frame.task.properties) {
        if (properties.body == object) {
            sample.friction_scale *= properties.friction_scale;
            sample.mass_scale = properties.mass_scale;
            sample.weight_scale = properties.weight_scale;
        } else if (sample.support >= 0 && properties.body == sample.support) {
            sample.support_friction_scale = properties.friction_scale;
        }
    }
}

}  // namespace

void GraspTrace::add(const frame::Frame& frame) {
    const size_t n = frame.fingers.size();
    Sample sample;
    sample.time = seconds(frame.time);
    sample.phase = frame.phase;
    sample.grip = frame.grip_force;
    sample.load = frame.load_force;
    sample.resumed = (frame.status & kResumed) != 0;
    sample.on_support = false;
    sample.support = -1;
    sample.n_support.setZero();
    sample.v_sliding.setZero();
    sample.v_WB.setZero();
    sample.awake = false;
    sample.touching.assign(n, false);
    sample.normal_force.assign(n, 0);
    sample.f_tangential_W.assign(n, Vec3::Zero());
    sample.torque = frame.turns.empty() ? kUnmeasured : 0;
    for (const frame::TurnFrame& turn : frame.turns)
        sample.torque = std::max(sample.torque, turn.t_sent_W.norm());
    if (object_ >= 0) {
        const frame::BodyFrame& object = frame.bodies[static_cast<size_t>(object_)];
        sample.X_WB = object.X_WB;
        sample.v_WB = object.v_WB;
        sample.awake = object.awake != 0;
    }
    for (const frame::FingerFrame& finger : frame.fingers) {
        sample.p_WP.push_back(finger.p_WP);
        sample.v_WH.push_back(finger.v_WH);
        sample.f_sent_W.push_back(finger.f_sent_W);
    }
    add_contacts(sample, frame, object_);
    add_properties(sample, frame, object_);
    // a vector that grows moves its samples, of more than half a kilobyte each, again and again
    if (samples_.capacity() == 0) samples_.reserve(kUsualSamples);
    samples_.push_back(std::move(sample));
}

GraspTrace GraspTrace::part(Range range) const {
    GraspTrace out(object_, tick_);
    const auto at = [&](size_t i) { return samples_.begin() + static_cast<ptrdiff_t>(i); };
    out.samples_.assign(at(range.first), at(range.last));
    return out;
}

Range GraspTrace::between(double from, double to) const {
    const auto at = [&](double t) {
        const double index =
            std::round((t - (samples_.empty() ? 0 : samples_.front().time)) / tick_);
        return static_cast<size_t>(std::clamp(index, 0.0, static_cast<double>(samples_.size())));
    };
    return {at(from), at(to)};
}

Range GraspTrace::of_phase(int phase) const {
    Range range{samples_.size(), 0};
    for (size_t i = 0; i < samples_.size(); ++i) {
        if (samples_[i].phase != phase) continue;
        range.first = std::min(range.first, i);
        range.last = i + 1;
    }
    return range;
}

bool GraspTrace::Sample::touched() const {
    return std::any_of(touching.begin(), touching.end(), [](char t) { return t; });
}

size_t GraspTrace::lift_off() const {
    for (size_t i = 0; i < samples_.size(); ++i) {
        if (samples_[i].touched() && !samples_[i].on_support) return i;
    }
    return samples_.size();
}

bool GraspTrace::all_touching(Range range) const {
    for (size_t i = range.first; i < range.last; ++i) {
        for (const char touching : samples_[i].touching) {
            if (!touching) return false;
        }
    }
    return range.size() > 0;
}

double GraspTrace::slip(Range range) const {
    double most = 0;
    for (size_t f = 0; f < fingers(); ++f) most = std::max(most, slip(range, f));
    return most;
}

double GraspTrace::slip(Range range, size_t finger) const {
    double most = 0;
    if (range.size() == 0) return most;
    const Sample& start = samples_[range.first];
    const Vec3 reference = start.X_WB.inverse() * start.p_WP[finger];
    for (size_t i = range.first; i < range.last; ++i) {
        const Sample& s = samples_[i];
        most = std::max(most, (s.X_WB.inverse() * s.p_WP[finger] - reference).norm());
    }
    return most;
}

double GraspTrace::height_rms(Range range) const {
    double mean = 0;
    double square = 0;
    const auto n = static_cast<double>(range.size());
    for (size_t i = range.first; i < range.last; ++i) mean += samples_[i].X_WB.p.z() / n;
    for (size_t i = range.first; i < range.last; ++i)
        square += std::pow(samples_[i].X_WB.p.z() - mean, 2) / n;
    return std::sqrt(square);
}

double GraspTrace::height_range(Range range) const {
    if (range.size() == 0) return 0;
    double low = samples_[range.first].X_WB.p.z();
    double high = low;
    for (size_t i = range.first; i < range.last; ++i) {
        low = std::min(low, samples_[i].X_WB.p.z());
        high = std::max(high, samples_[i].X_WB.p.z());
    }
    return high - low;
}

double GraspTrace::sag(Range range) const {
    double low = 0;
    for (size_t i = range.first; i < range.last; ++i) {
        low = std::min(low, samples_[i].X_WB.p.z() - samples_[range.first].X_WB.p.z());
    }
    return low;
}

double GraspTrace::axis_tilt_rms(Range range) const {
    if (range.size() == 0 || fingers() < 2) return 0;
    const auto axis = [&](size_t i) { return axis_of(samples_[i]); };
    Vec3 mean = Vec3::Zero();
    for (size_t i = range.first; i < range.last; ++i) mean += axis(i);
    mean.normalize();
    double square = 0;
    for (size_t i = range.first; i < range.last; ++i) {
        square += std::pow(std::atan2(axis(i).cross(mean).norm(), axis(i).dot(mean)), 2);
    }
    return std::sqrt(square / static_cast<double>(range.size()));
}

double GraspTrace::turn_at(size_t reference, size_t sample) const {
    // twist about the grasp axis (swing-twist decomposition)
    const Sample& a = samples_[reference];
    const Sample& b = samples_[sample];
    const Vec3 axis = axis_of(a);
    const Quat turned = b.X_WB.R * a.X_WB.R.conjugate();
    return 2 * std::atan2(turned.vec().dot(axis), turned.w());
}

double GraspTrace::turn(Range range) const {
    double most = 0;
    if (fingers() < 2) return most;
    for (size_t i = range.first; i < range.last; ++i)
        most = std::max(most, std::abs(turn_at(range.first, i)));
    return most;
}

double GraspTrace::force_above_5_hz(Range range) const {
    double worst = 0;
    for (size_t f = 0; f < fingers(); ++f) {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> force;
            for (size_t i = range.first; i < range.last; ++i)
                force.push_back(samples_[i].f_sent_W[f][axis]);
            if (force.empty()) return 0;
            for (const double high : model::high_pass(force, 5.0, 1 / tick_)) square += high * high;
        }
        worst = std::max(worst, std::sqrt(square / static_cast<double>(range.size())));
    }
    return worst;
}

double GraspTrace::weight_felt(Range range) const {
    double sum = 0;
    for (size_t i = range.first; i < range.last; ++i) {
        for (const Vec3& f : samples_[i].f_sent_W) sum -= f.z();
    }
    return sum / static_cast<double>(range.size());
}

double GraspTrace::mean(Range range, double Sample::*of) const {
    double sum = 0;
    for (size_t i = range.first; i < range.last; ++i) sum += samples_[i].*of;
    return sum / static_cast<double>(range.size());
}

double GraspTrace::peak_grip(Range range) const {
    double most = 0;
    for (size_t i = range.first; i < range.last; ++i) most = std::max(most, samples_[i].grip);
    return most;
}

double GraspTrace::peak_force(Range range) const {
    double most = 0;
    for (size_t i = range.first; i < range.last; ++i) {
        for (const Vec3& f : samples_[i].f_sent_W) most = std::max(most, f.norm());
    }
    return most;
}

double GraspTrace::peak_torque(Range range) const {
    double most = samples_[range.first].torque;
    for (size_t i = range.first; i < range.last; ++i) most = std::max(most, samples_[i].torque);
    return most;
}

double GraspTrace::mean_torque(Range range) const {
    double sum = 0;
    for (size_t i = range.first; i < range.last; ++i) sum += samples_[i].torque;
    return sum / static_cast<double>(range.size());
}

double GraspTrace::mean_force(Range range) const {
    double most = 0;
    for (size_t f = 0; f < fingers(); ++f) {
        double sum = 0;
        for (size_t i = range.first; i < range.last; ++i) sum += samples_[i].f_sent_W[f].norm();
        most = std::max(most, sum / static_cast<double>(range.size()));
    }
    return most;
}

}  // namespace dihaptic::analysis
