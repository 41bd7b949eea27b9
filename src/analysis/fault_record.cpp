#include "analysis/fault_record.h"

#include <initializer_list>

#include "base/unit.h"

namespace dihaptic::analysis {
namespace {

void add_vector(std::vector<Table::Cell>& row, const Vec3& value, double scale) {
    for (int axis = 0; axis < 3; ++axis) row.emplace_back(value[axis] * scale);
}

}  // namespace

void FaultRecord::add(const frame::Frame& frame) {
    if ((frame.status & kResumed) != 0) ended_ = false;
    if (ended_) return;
    const auto old = [&] { return last_.front().time < frame.time - kBefore; };
    if (!last_.empty() && old()) {
        // This runs in each tick of a session, so the memory of the oldest frame is reused.
        last_.splice(last_.end(), last_, last_.begin());
    } else {
        last_.emplace_back();
    }
    frame::Frame& kept = last_.back();
    kept.time = frame.time;
    kept.status = frame.status;
    kept.lateness = frame.lateness;
    kept.tick_duration = frame.tick_duration;
    kept.fingers = frame.fingers;
    kept.turns = frame.turns;
    while (old()) last_.pop_front();
    if ((frame.status & kForceOff) == 0) return;
    ended_ = true;
    if ((frame.status & kStopped) == 0) faults_.splice(faults_.end(), last_);
    last_.clear();
}

Table FaultRecord::table() const {
    Table table;
    table.columns = {{"time_s", "of the tick"},
                     {"status", "faults in the tick"},
                     {"lateness_ms", "delay of its wake-up; empty on the virtual clock"},
                     {"last_tick_ms", "duration of the previous tick"}};
    const auto add_columns = [&](const std::string& finger,
                                 std::initializer_list<const char*> fields) {
        for (const char* what : fields) {
            for (const char axis : {'x', 'y', 'z'}) {
                std::string name = finger + "_" + what;
                name[name.find('%')] = axis;
                table.columns.push_back({name, ""});
            }
        }
    };
    for (const std::string& finger : fingers_) {
        add_columns(finger, {"device_position_%_mm", "device_velocity_%_m_s", "force_asked_%_N",
                             "force_sent_%_N"});
    }
    for (const std::string& finger : turning_) {
        add_columns(finger, {"device_rotation_%_deg", "device_angular_velocity_%_rad_s",
                             "torque_asked_%_Nm", "torque_sent_%_Nm"});
    }
    for (const frame::Frame& frame : faults_) {
        std::vector<Table::Cell> row{seconds(frame.time), words(frame.status), frame.lateness * 1e3,
                                     frame.tick_duration * 1e3};
        for (const frame::FingerFrame& finger : frame.fingers) {
            add_vector(row, finger.p_DH, 1e3);
            add_vector(row, finger.v_DH, 1);
            add_vector(row, finger.f_asked_W, 1);
            add_vector(row, finger.f_sent_W, 1);
        }
        for (const frame::TurnFrame& turn : frame.turns) {
            add_vector(row, rotation_vector(turn.R_DH), 1 / kDegree);
            add_vector(row, turn.w_DH, 1);
            add_vector(row, turn.t_asked_W, 1);
            add_vector(row, turn.t_sent_W, 1);
        }
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace dihaptic::analysis
