// Inlet receives a stream of numbers of the Lab Streaming Layer, e.g. from a tracker.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::outlets::lsl {

class Inlet {
  public:
    /// `library`: path of liblsl; empty: found by the system. Throws Error for `place` if liblsl
    /// cannot be loaded.
    Inlet(const std::string& stream, const std::string& library, const Place& place);
    ~Inlet();

    /// Looks for the stream, for the given time; returns whether it exists. It may reappear after
    /// a loss. Throws Error if liblsl cannot open it.
    bool find(std::chrono::duration<double> patience);
    /// Number of values in a sample of the stream found.
    int channels() const;
    /// Waits for a sample with that number of values, for the given time; returns whether one
    /// arrived. Throws Error when the stream is lost.
    bool pull(std::span<float> values, std::chrono::duration<double> patience);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::outlets::lsl
