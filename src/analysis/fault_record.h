// Records what led to a session's faults: the second before force went off, tick by tick, as a
// table that people can read. All of it is in raw.log too.
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

    /// Takes the frames in their order.
    void add(const frame::Frame& frame);
    /// Rows from kBefore before each fault to its tick; empty without a fault. A stop by the
    /// operator is not a fault.
    Table table() const;

    static constexpr Time kBefore = std::chrono::seconds(1);

  private:
    std::vector<std::string> fingers_;
    std::vector<std::string> turning_;
    std::list<frame::Frame> last_;    // without bodies and contacts
    bool ended_ = false;              // force is off, until the session goes on
    std::list<frame::Frame> faults_;  // frames that led to each fault, one after the other
};

}  // namespace dihaptic::analysis
