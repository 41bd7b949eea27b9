// What a session is about, known before its first tick. It stands in session.yaml, and in the head
// of raw.log, so that the log alone can be replayed and recovered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "recording/moved_by.h"
#include "recording/study.h"

namespace dihaptic::recording {

/// A named stretch of a trial, by the session's clock.
struct PhaseInfo {
    std::string name;
    double start = 0;  ///< from the trial's beginning [s]
    double end = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("start", start, Field::of(Quantity::time));
        v("end", end, Field::of(Quantity::time));
    }
};

/// What held a finger, and what its force was limited by.
struct DeviceRecord {
    std::string finger;
    std::string model;
    double peak_force = 0;                    ///< [N]
    std::optional<double> continuous_force;   ///< unset: as long as the peak [N]
    std::optional<Vec3> workspace;            ///< edges of the box around D's origin [m]
    bool orientation = false;                 ///< whether it is measured
    double peak_torque = 0;                   ///< [N*m]
    std::optional<double> continuous_torque;  ///< [N*m]
    double scale = 1;  ///< of the world over the hand's movement, in forces and lengths above too
    bool simulated = false;  ///< so that late ticks were no fault
    /// That what was held in late ticks was judged by; unset: they softened nothing [N*s/m].
    std::optional<double> damping;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        v("model", model);
        v("peak_force", peak_force, Field::of(Quantity::force));
        v("continuous_force", continuous_force, Field::of(Quantity::force));
        v("workspace", workspace, Field::length());
        v("orientation", orientation);
        v("peak_torque", peak_torque, Field::of(Quantity::torque));
        v("continuous_torque", continuous_torque, Field::of(Quantity::torque));
        v("scale", scale);
        v("simulated", simulated);
        v("damping", damping, Field::of(Quantity::damping));
    }
};

/// A frozen input, as it was when the session began.
struct InputFile {
    std::string file;      ///< in the session's folder
    std::string checksum;  ///< CRC-32, in hexadecimal

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required());
        v("checksum", checksum, Field::text().required());
    }
};

struct Setup {
    std::string identity;  ///< one of a kind, in session.yaml and in raw.log: they belong together
    std::string title;
    std::string experiment;  ///< name of the file
    std::string clock;       ///< virtual or real
    std::string seed;        ///< of everything random
    std::string object;      ///< the body that summaries are about
    MovedBy moved_by;        ///< the hand
    Study study;
    std::vector<DeviceRecord> devices;
    std::vector<PhaseInfo> phases;      ///< of every trial
    std::vector<std::string> outcomes;  ///< of trials, as frames count them
    std::vector<std::string> messages;  ///< shown to the person, as frames count them
    std::vector<InputFile> inputs;

    /// How long the session was to be [s]; 0: not known.
    double planned() const { return phases.empty() ? 0 : phases.back().end; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("identity", identity);
        v("title", title);
        v("experiment", experiment);
        v("clock", clock);
        v("seed", seed);
        v("object", object);
        v("moved_by", moved_by);
        v("study", study);
        v("devices", devices);
        v("phases", phases);
        v("outcomes", outcomes);
        v("messages", messages);
        v("inputs", inputs);
    }
};

}  // namespace dihaptic::recording
