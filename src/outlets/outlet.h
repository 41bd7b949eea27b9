// The interface to a lab's other recording equipment: event codes are sent to outlets, and triggers
// are received from them.
//
// An outlet is created before a session starts; its constructor may allocate memory and throw an
// Error that names a remedy. After that, an outlet is called only by the Station's thread, never by
// the servo's.
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "base/node.h"

namespace dihaptic {
class JsonSchema;
}

namespace dihaptic::outlets {

using Clock = std::chrono::steady_clock;

/// An outlet, as described in the rig file.
struct OutletConfig {
    std::string kind;
    Node options;  ///< read by the code of this kind of outlet
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, Field::text().required().says("Kind of outlet: serial or lsl."));
        v("options", options, says("Options of that kind."));
    }
};

/// A quantity sampled in every tick.
struct Channel {
    std::string label;
    std::string unit;
};

/// What outlets are told about the session.
struct About {
    std::string session;  ///< name of the session's folder
    double rate = 0;      ///< sampling rate [Hz]
    std::vector<Channel> channels;
};

class Outlet {
  public:
    virtual ~Outlet() = default;

    /// Sends an event code (1 to 255) that belongs to the tick at time `at`. Throws Error when the
    /// code cannot be sent.
    virtual void mark(int code, Clock::time_point at) = 0;
    /// Sends one value for each of About::channels. Throws Error when the values cannot be sent.
    virtual void sample(std::span<const float>, Clock::time_point) {}
    /// Called about once per millisecond. Returns the trigger (1 to 255) received since the last
    /// call, or 0 if none was received. Throws Error when triggers can no longer be received.
    virtual int tend(Clock::time_point) { return 0; }
};

/// An entry in the table of outlet kinds. Each subfolder of this folder implements one kind.
struct Kind {
    const char* name;
    /// Checks the options without opening the outlet.
    void (*check)(const OutletConfig& config, Diagnostics& diagnostics);
    std::unique_ptr<Outlet> (*make)(const OutletConfig& config, const About& about);
    bool samples;   ///< whether the outlet accepts samples
    bool triggers;  ///< whether the outlet can receive triggers
    /// Adds the outlet's options to the JSON schema of rig files (base/json_schema.h).
    void (*options)(JsonSchema& schema);
};

std::span<const Kind> kinds();
/// Returns the outlet kind with this name, or null if there is none.
const Kind* find_kind(const std::string& name);

/// Checks a rig's outlets; reports every problem to `diagnostics`.
void check(const std::vector<OutletConfig>& outlets, Diagnostics& diagnostics);

}  // namespace dihaptic::outlets
