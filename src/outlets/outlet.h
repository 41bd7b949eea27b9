// The interface to a lab's other recording equipment: event codes are sent to outlets, and triggers
// come in from them.
//
// An outlet is made before a session starts; its construction may allocate and throw an Error with
// a remedy. After that only the Station's thread calls it, never the servo's.
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
    Node options;  ///< read by the kind's own code
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, Field::text().required().says("Kind of outlet: serial or lsl."));
        v("options", options, says("Options of that kind."));
    }
};

/// A value sampled in each tick.
struct Channel {
    std::string label;
    std::string unit;
};

/// Information about the session, for outlets.
struct About {
    std::string session;  ///< name of its folder
    double rate = 0;      ///< rate of samples [Hz]
    std::vector<Channel> channels;
};

class Outlet {
  public:
    virtual ~Outlet() = default;

    /// Sends an event code, 1 to 255, from the tick at `at`. Throws Error when it cannot be sent.
    virtual void mark(int code, Clock::time_point at) = 0;
    /// Sends a value for each of About::channels. Throws Error when they cannot be sent.
    virtual void sample(std::span<const float>, Clock::time_point) {}
    /// Called about every millisecond. Returns the trigger received since, 1 to 255; 0: none.
    /// Throws Error when no trigger can be received any more.
    virtual int tend(Clock::time_point) { return 0; }
};

/// An entry of the table of kinds, one for each subfolder of this folder.
struct Kind {
    const char* name;
    /// Checks the options, without opening anything.
    void (*check)(const OutletConfig& config, Diagnostics& diagnostics);
    std::unique_ptr<Outlet> (*make)(const OutletConfig& config, const About& about);
    bool samples;   ///< whether it accepts samples
    bool triggers;  ///< whether it can receive triggers
    /// Adds its options to the schema of rig files (base/json_schema.h).
    void (*options)(JsonSchema& schema);
};

std::span<const Kind> kinds();
/// The kind with that name; null if there is none.
const Kind* find_kind(const std::string& name);

/// Checks a rig's outlets; every problem goes to `diagnostics`.
void check(const std::vector<OutletConfig>& outlets, Diagnostics& diagnostics);

}  // namespace dihaptic::outlets
