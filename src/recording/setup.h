// The description of a session before its first tick. It is stored both in session.yaml and in the
// head of raw.log, so that the session can be replayed and recovered from the log alone.
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

/// A named part of a trial, defined by session time.
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

/// The device assigned to a finger.
struct DeviceRecord : frame::DeviceInfo {
    std::string finger;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        // recordings without this value date from when late ticks did not soften the coupling
        if constexpr (requires { v.mentions("damping"); }) {
            if (!v.mentions("damping")) damping = std::numeric_limits<double>::infinity();
        }
        DeviceInfo::visit(v);
    }
};

/// A frozen input, as it was at the start of the session.
struct InputFile {
    std::string file;      ///< name in the session's folder
    std::string checksum;  ///< CRC-32 in hexadecimal

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required());
        v("checksum", checksum, Field::text().required());
    }
};

struct Setup {
    std::string identity;  ///< unique ID that shows that session.yaml and raw.log belong together
    std::string title;
    std::string experiment;  ///< name of the experiment file
    std::string clock;       ///< "virtual" or "real"
    std::string seed;        ///< seed of all random numbers
    std::string object;      ///< the body that summaries describe
    MovedBy moved_by;        ///< who moved the hand
    Study study;
    std::vector<DeviceRecord> devices;
    std::vector<PhaseInfo> phases;       ///< phases of each trial
    std::vector<std::string> outcomes;   ///< names of trial outcomes, by their index in frames
    std::vector<std::string> messages;   ///< messages to the person, by their index in frames
    std::vector<std::string> variables;  ///< the task's variables, in the order used in frames
    std::vector<std::string> levels;     ///< levels chosen by procedures; in frames after variables
    std::vector<std::string> answers;    ///< answers requested by states; in frames after levels
    std::vector<std::string> forms;      ///< title and version of each state's form, if it has one
    std::vector<std::string> pages;      ///< texts or pictures of pages, by their index in frames
    std::vector<std::string> sounds;     ///< names of sounds, by their index in frames
    std::vector<InputFile> inputs;

    /// Planned length of the session [s]; 0 if unknown.
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
