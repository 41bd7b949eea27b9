// The experiment file (docs/files.md): names the scene, the rig, and what moves the hand.
#pragma once

#include <optional>
#include <string>

#include "base/study.h"
#include "hand/movement.h"
#include "hand/spec.h"
#include "task/task.h"

namespace dihaptic::task {

/// A recorded movement that pulls the simulated fingers, and the block that stands where they
/// closed.
struct MovementSpec {
    std::string file;  ///< CSV, relative to the experiment file; --movement replaces it
    hand::RecordingAxes axes = hand::RecordingAxes::world;
    std::string block;  ///< a box of the scene: turned and sized to stand between the fingers
    double squeeze =
        0.006;  ///< distance that each recorded finger goes beyond the block's face [m]
    std::optional<double>
        width;  ///< width of the block along the grasp; unset: from aperture and squeeze [m]
    std::optional<double>
        grasp_at;  ///< when the fingers closed; unset: found from the movement [s]
    Place place;   ///< where the file names the block

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file);
        v("axes", axes, Field::text().required());
        v("block", block, Field::text().required());
        v("squeeze", squeeze, Field::length().within(0, 0.1));
        v("width", width, Field::length().within(1e-3, 1));
        v("grasp_at", grasp_at, Field::of(Quantity::time).within(0, hand::kLongestScript));
        if constexpr (requires { v.place(); }) place = v.place_of("block");
    }
};

struct Experiment {
    std::string title;
    std::string scene;  ///< file, relative to this one
    std::string rig;    ///< file, relative to this one; empty: ideal simulated devices
    std::optional<hand::HandSpec> hand;  ///< replaces the scene's hand
    std::optional<MovementSpec> movement;
    std::optional<Task> task;  ///< trials, which replace the hand's script
    Study study;
    Node settings;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title);
        v("scene", scene, Field::text().required());
        v("rig", rig);
        v("hand", hand);
        v("movement", movement);
        v("task", task);
        v("study", study);
        v("settings", settings);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Reads an experiment file, without the files that it names. Problems go to `diagnostics`.
Experiment read_experiment(const std::string& file, Diagnostics& diagnostics);

enum class FileKind { scene, rig, experiment, movement, population, unknown };
/// Tells the kind of a file from its name and its keys. Throws Error when it cannot be read.
FileKind kind_of(const std::string& file);

}  // namespace dihaptic::task
