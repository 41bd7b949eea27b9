// Inlet receives a stream of numbers through the Lab Streaming Layer, e.g. from a tracker.
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
    /// `library` is the path of liblsl; if it is empty, the system finds the library. Throws Error
    /// for `place` if liblsl cannot be loaded.
    Inlet(const std::string& stream, const std::string& library, const Place& place);
    ~Inlet();

    /// Looks for the stream for at most `patience`; returns whether it was found. After a loss, the
    /// stream may be found again. Throws Error if liblsl cannot open the stream.
    bool find(std::chrono::duration<double> patience);
    /// Number of values in each sample of the stream that was found.
    int channels() const;
    /// Waits for the next sample for at most `patience`; returns whether a sample arrived. The
    /// sample must have as many values as `values`. Throws Error when the stream is lost.
    bool pull(std::span<float> values, std::chrono::duration<double> patience);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::outlets::lsl
