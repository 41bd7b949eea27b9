// Records the course of events before a session's faults: the second before force went off, tick by
// tick, as a readable table. raw.log contains all of it too.
#pragma once

#include <list>
#include <string>
#include <vector>

#include "base/table.h"
#include "frame/frame.h"

namespace dihaptic::analysis {

class FaultRecord {
  public:
    /// `turning`: the fingers whose devices measure orientation.
    explicit FaultRecord(std::vector<std::string> fingers, std::vector<std::string> turning = {})
        : fingers_(std::move(fingers)), turning_(std::move(turning)) {}

    /// Receives the frames in order.
    void add(const frame::Frame& frame);
    /// Rows from kBefore before each fault to its tick; empty without a fault. A stop by the
    /// operator is not a fault.
    Table table() const;

    static constexpr Time kBefore = std::chrono::seconds(1);

  private:
    std::vector<std::string> fingers_;
    std::vector<std::string> turning_;
    std::list<frame::Frame> last_;    // without bodies and contacts
    bool ended_ = false;              // force is off, until the session continues
    std::list<frame::Frame> faults_;  // frames that led to each fault, one after the other
};

}  // namespace dihaptic::analysis
