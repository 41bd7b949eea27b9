#include "task/file/experiment.h"

#include <filesystem>

namespace dihaptic::task {

namespace {

void read_paths(Task& task, const std::string& folder, Diagnostics& diagnostics) {
    for (State& state : task.states) {
        for (DriveSpec& drive : state.drives) {
            if (drive.path) drive.path->read_file(folder, diagnostics);
        }
    }
}

}  // namespace

Experiment read_experiment(const std::string& file, Diagnostics& diagnostics) {
    Experiment experiment;
    try {
        read_fields(experiment, read_yaml(file), diagnostics);
        if (experiment.task)
            read_paths(*experiment.task, std::filesystem::path(file).parent_path().string(),
                       diagnostics);
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
    return experiment;
}

bool is_movement(const std::string& file) {
    return file.ends_with(".csv") || file.ends_with(".tsv");
}

FileKind kind_of(const std::string& file) {
    if (is_movement(file)) return FileKind::movement;
    const Node root = read_yaml(file);
    if (root.find("scene") != nullptr) return FileKind::experiment;
    if (root.find("bodies") != nullptr) return FileKind::scene;
    if (root.find("sessions") != nullptr) return FileKind::study;
    if (root.find("devices") != nullptr) return FileKind::rig;
    if (root.find("traits") != nullptr || root.find("based_on") != nullptr)
        return FileKind::population;
    return FileKind::unknown;
}

}  // namespace dihaptic::task
