// The description of a session, as known before its first tick. It is stored in session.yaml and in
// the head of raw.log, so that the log alone can be replayed and recovered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/field.h"
#include "base/field_reader.h"
#include "base/study.h"
#include "frame/device_info.h"
#include "recording/moved_by.h"

namespace dihaptic::recording {

/// A named stretch of a trial, timed by the session's clock.
struct PhaseInfo {
    std::string name;
    double start = 0;  ///< time from the trial's beginning [s]
    double end = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("start", start, Field::of(Quantity::time));
        v("end", end, Field::of(Quantity::time));
    }
};

/// The device that held a finger.
struct DeviceRecord : frame::DeviceInfo {
    std::string finger;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        // in recordings without this value, late ticks did not soften the coupling
        if constexpr (requires { v.mentions("damping"); }) {
            if (!v.mentions("damping")) damping = std::numeric_limits<double>::infinity();
        }
        DeviceInfo::visit(v);
    }
};

/// A frozen input, in its state at the start of the session.
struct InputFile {
    std::string file;      ///< name in the session's folder
    std::string checksum;  ///< CRC-32, in hexadecimal

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required());
        v("checksum", checksum, Field::text().required());
    }
};

struct Setup {
    std::string identity;  ///< unique; shows that session.yaml and raw.log belong together
    std::string title;
    std::string experiment;  ///< name of the file
    std::string clock;       ///< virtual or real
    std::string seed;        ///< seed of everything random
    std::string object;      ///< the body that summaries are about
    MovedBy moved_by;        ///< who moved the hand
    Study study;
    std::vector<DeviceRecord> devices;
    std::vector<PhaseInfo> phases;       ///< phases of every trial
    std::vector<std::string> outcomes;   ///< outcomes of trials, by their index in frames
    std::vector<std::string> messages;   ///< messages to the person, by their index in frames
    std::vector<std::string> variables;  ///< the task's variables, by their index in frames
    std::vector<std::string> levels;  ///< numbers that procedures choose; in frames after variables
    std::vector<std::string> answers;  ///< answers that states request; in frames after levels
    std::vector<std::string> forms;    ///< by state: title and version of its form, if it has one
    std::vector<std::string> pages;    ///< pages' texts or pictures, by their index in frames
    std::vector<std::string> sounds;   ///< sounds' names, by their index in frames
    std::vector<InputFile> inputs;

    /// Planned length of the session [s]; 0: not known.
    double planned() const { return phases.empty() ? 0 : phases.back().end; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("identity", identity);
        v("title", title);
        v("experiment", experiment);
        v("clock", clock);
        v("seed", seed, Field::number().at_least(0));
        v("object", object);
        v("moved_by", moved_by);
        v("study", study);
        v("devices", devices);
        v("phases", phases);
        v("outcomes", outcomes);
        v("messages", messages);
        v("variables", variables);
        v("levels", levels);
        v("answers", answers);
        v("forms", forms);
        v("pages", pages);
        v("sounds", sounds);
        v("inputs", inputs);
    }
};

}  // namespace dihaptic::recording
