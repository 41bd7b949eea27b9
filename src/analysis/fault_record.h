// What led to a session's faults: the second before force went off, tick by tick, as a table that a
// person can read. All of it is in raw.log too.
#pragma once

#include <list>
#include <string>
#include <vector>

#include "base/table.h"
#include "servo/frame.h"

namespace dihaptic::analysis {

class FaultRecord {
  public:
    /// `turning`: those of the fingers whose devices measure orientation.
    explicit FaultRecord(std::vector<std::string> fingers, std::vector<std::string> turning = {})
        : fingers_(std::move(fingers)), turning_(std::move(turning)) {}

    /// Frames in their order.
    void add(const servo::Frame& frame);
    /// Rows from kBefore before each fault to its tick; none without a fault. An operator who
    /// stops a session is none.
    Table table() const;

    static constexpr Time kBefore = std::chrono::seconds(1);

  private:
    std::vector<std::string> fingers_;
    std::vector<std::string> turning_;
    std::list<servo::Frame> last_;    // without bodies and contacts
    bool ended_ = false;              // until the session goes on
    std::list<servo::Frame> faults_;  // what led to each, one after the other
};

}  // namespace dihaptic::analysis
