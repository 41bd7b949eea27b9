// The experiment file (docs/files.md): names the scene, the rig, and what moves the hand.
#pragma once

#include <optional>
#include <string>

#include "base/study.h"
#include "hand/movement.h"
#include "hand/spec.h"
#include "task/file/task.h"

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
        grasp_at;      ///< when the fingers closed; unset: found from the movement [s]
    Place place;       ///< where the file names the block
    Place file_place;  ///< where it names the movement

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, says("CSV file of the movement, found as scene is."));
        v("axes", axes,
          Field::text().required().says(
              "Axes of the file: x right, y up, z toward the person, or the world's."));
        v("block", block,
          Field::text().required().says(
              "Box of the scene that is placed where the fingers closed."));
        v("squeeze", squeeze,
          Field::length().within(0, 0.1).says(
              "How far each recorded finger goes beyond the block's face."));
        v("width", width,
          Field::length().within(1e-3, 1).says("Width of the block along the grasp; left out, it "
                                               "follows from the aperture and squeeze."));
        v("grasp_at", grasp_at,
          Field::of(Quantity::time)
              .within(0, hand::kLongestScript)
              .says("When the fingers closed; left out, it is found from the movement."));
        if constexpr (requires { v.place(); }) {
            place = v.place_of("block");
            file_place = v.place_of("file");
        }
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
        v("title", title, says("Title of the experiment."));
        v("scene", scene,
          Field::text().required().says(
              "Scene file, relative to this file; one that is not there is looked for among those "
              "that come with the program, such as scenes/block-on-table.yaml."));
        v("rig", rig,
          says("Rig file, found as scene is; left out, the devices are simulated and ideal."));
        v("hand", hand, says("The simulated hand, in place of the scene's."));
        v("movement", movement,
          says("Recorded movement that pulls the simulated fingers, in place of the "
               "hand's script."));
        v("task", task, says("Trials, in place of one script."));
        v("study", study, says("What archives ask about the study."));
        v("settings", settings, says("Settings, over those of scene and rig."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Reads an experiment file, with the paths of its drives, without the other files that it names.
/// Problems go to `diagnostics`.
Experiment read_experiment(const std::string& file, Diagnostics& diagnostics);

enum class FileKind { scene, rig, experiment, movement, population, unknown };
/// Tells the kind of a file from its name and its keys. Throws Error when it cannot be read.
FileKind kind_of(const std::string& file);
/// Whether a file is a movement by its name: tables of systems for capturing motion end in either.
bool is_movement(const std::string& file);

}  // namespace dihaptic::task
