#include "analysis/fault_record.h"

namespace dihaptic::analysis {
namespace {

void add_vector(std::vector<Table::Cell>& row, const Vec3& value, double scale) {
    for (int axis = 0; axis < 3; ++axis) row.emplace_back(value[axis] * scale);
}

/// All that a finger or a tick has to say, in words.
std::string words(uint32_t status) {
    std::string out;
    for (int bit = 0; bit < servo::kStatusBits; ++bit) {
        if ((status >> bit & 1u) == 0) continue;
        if (!out.empty()) out += "; ";
        out += servo::describe(static_cast<servo::Status>(1u << bit)).what;
    }
    return out;
}

}  // namespace

void FaultRecord::add(const servo::Frame& frame) {
    if (ended_) return;
    servo::Frame& kept = last_.emplace_back();
    kept.time = frame.time;
    kept.status = frame.status;
    kept.lateness = frame.lateness;
    kept.tick_duration = frame.tick_duration;
    kept.fingers = frame.fingers;
    while (last_.front().time < frame.time - kBefore) last_.pop_front();
    if ((frame.status & servo::kForceOff) == 0) return;
    ended_ = true;
    faulted_ = (frame.status & servo::kStopped) == 0;
}

Table FaultRecord::table() const {
    Table table;
    table.columns = {{"time_s", "of the tick"},
                     {"status", "what the tick could not do as asked"},
                     {"lateness_ms", "of its wake-up; empty on the virtual clock"},
                     {"last_tick_ms", "how long the one before took"}};
    for (const std::string& finger : fingers_) {
        for (const char* what : {"device_position_%_mm", "device_velocity_%_m_s", "force_asked_%_N",
                                 "force_sent_%_N"}) {
            for (const char axis : {'x', 'y', 'z'}) {
                std::string name = finger + "_" + what;
                name[name.find('%')] = axis;
                table.columns.push_back({name, ""});
            }
        }
    }
    if (!faulted_) return table;
    for (const servo::Frame& frame : last_) {
        std::vector<Table::Cell> row{seconds(frame.time), words(frame.status), frame.lateness * 1e3,
                                     frame.tick_duration * 1e3};
        for (const servo::FingerFrame& finger : frame.fingers) {
            add_vector(row, finger.p_DH, 1e3);
            add_vector(row, finger.v_DH, 1);
            add_vector(row, finger.f_asked_W, 1);
            add_vector(row, finger.f_sent_W, 1);
        }
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace dihaptic::analysis
