// Records what happened in the last second before force went off because of a fault, tick by tick,
// as a readable table. raw.log contains all of this too.
#pragma once

#include <list>
#include <string>
#include <vector>

#include "base/table.h"
#include "frame/frame.h"

namespace dihaptic::analysis {

class FaultRecord {
  public:
    /// `turning`: names of the fingers whose devices measure orientation.
    explicit FaultRecord(std::vector<std::string> fingers, std::vector<std::string> turning = {})
        : fingers_(std::move(fingers)), turning_(std::move(turning)) {}

    /// Adds a frame. Frames must be added in order.
    void add(const frame::Frame& frame);
    /// Returns the rows from kBefore before each fault up to its tick; the table is empty if there
    /// was no fault. A stop by the operator is not a fault.
    Table table() const;

    static constexpr Time kBefore = std::chrono::seconds(1);

  private:
    std::vector<std::string> fingers_;
    std::vector<std::string> turning_;
    std::list<frame::Frame> last_;    // recent frames, without bodies and contacts
    bool ended_ = false;              // whether force is off until the session continues
    std::list<frame::Frame> faults_;  // frames that led to each fault, one fault after the other
};

}  // namespace dihaptic::analysis
