// The experiment file (docs/files.md): it specifies the scene, the rig, and the hand's movement or
// task.
#pragma once

#include <optional>
#include <string>

#include "base/study.h"
#include "hand/movement.h"
#include "hand/spec.h"
#include "task/file/task.h"

namespace dihaptic::task {

/// A recorded movement that pulls the simulated fingers, and the block that is placed where the
/// fingers closed.
struct MovementSpec {
    std::string file;  ///< CSV file, relative to the experiment file; overridden by --movement
    hand::RecordingAxes axes = hand::RecordingAxes::world;
    std::string block;  ///< box in the scene, which is rotated and sized to fit between the fingers
    /// Distance that each recorded finger moves beyond the block's face [m].
    double squeeze = 0.006;
    std::optional<double> width;  ///< width of the block along the grasp axis; if unset, computed
                                  ///< from aperture and squeeze [m]
    /// Time at which the fingers closed; if unset, detected from the movement [s].
    std::optional<double> grasp_at;
    Place place;       ///< location of the key `block` in the file
    Place file_place;  ///< location of the key `file` in the file

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file,
          says("CSV file of the movement; the search order is the same as for 'scene'."));
        v("axes", axes,
          Field::text().required().says(
              "Axes of the file: x right, y up, z toward the person; or the world axes."));
        v("block", block,
          Field::text().required().says(
              "Box of the scene that is placed where the fingers closed."));
        v("squeeze", squeeze,
          Field::length().within(0, 0.1).says(
              "Distance that each recorded finger moves beyond the block's face."));
        v("width", width,
          Field::length().within(1e-3, 1).says("Width of the block along the grasp axis; computed "
                                               "from the aperture and 'squeeze' if omitted."));
        v("grasp_at", grasp_at,
          Field::of(Quantity::time)
              .within(0, hand::kLongestScript)
              .says("Time at which the fingers closed; found from the movement if omitted."));
        if constexpr (requires { v.place(); }) {
            place = v.place_of("block");
            file_place = v.place_of("file");
        }
    }
};

struct Experiment {
    std::string title;
    std::string scene;  ///< scene file, relative to the experiment file
    std::string rig;    ///< rig file, relative to the experiment file; if empty, devices are ideal
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
              "Scene file, relative to this file; if it does not exist there, the file of that "
              "name that comes with the program is used, such as scenes/block-on-table.yaml."));
        v("rig", rig,
          says("Rig file; the search order is the same as for 'scene'. If omitted, ideal devices "
               "are simulated."));
        v("hand", hand, says("Simulated hand, in place of the hand in the scene."));
        v("movement", movement,
          says("Recorded movement that pulls the simulated fingers, in place of the "
               "hand's script."));
        v("task", task, says("Trials, in place of the hand's script."));
        v("study", study, says("Information about the study that archives require."));
        v("settings", settings, says("Settings, which override those of the scene and the rig."));
    }
};

/// Reads an experiment file, the paths of its drives and its forms, but no other files to which it
/// refers. Problems are added to `diagnostics`.
Experiment read_experiment(const std::string& file, Diagnostics& diagnostics);

enum class FileKind { scene, rig, experiment, movement, population, study, form, unknown };
/// Determines the kind of a file from its name and its keys. Throws Error if the file cannot be
/// read.
FileKind kind_of(const std::string& file);
/// Whether a file is a movement, judging by its extension: .csv, or .tsv as used by motion capture
/// systems.
bool is_movement(const std::string& file);

}  // namespace dihaptic::task
