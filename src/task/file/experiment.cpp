#include "task/file/experiment.h"

#include <algorithm>
#include <filesystem>

namespace dihaptic::task {

namespace {

/// Adds the scores of a state's form to the custom measures of the task.
void take_scores(State& state, std::vector<CustomMeasure>& measures) {
    for (const Score& score : state.form->scores) {
        const auto same = [&](const CustomMeasure& m) {
            return m.name == score.name && m.of == score.of;
        };
        auto found = std::find_if(measures.begin(), measures.end(), same);
        if (found == measures.end()) {
            CustomMeasure measure;
            measure.name = score.name;
            measure.of = score.of;
            measure.take = Take::last;
            measure.place = score.place;
            found = measures.insert(measures.end(), measure);
        }
        found->during.push_back(state.name);
    }
    state.form->scores.clear();
}

/// Reads the files named in states, and stores their contents in the states.
void read_files(Task& task, const std::string& folder, Diagnostics& diagnostics) {
    for (State& state : task.states) {
        for (DriveSpec& drive : state.drives) {
            if (drive.path) drive.path->read_file(folder, diagnostics);
        }
        if (!state.form) continue;
        state.form->read_file(folder, diagnostics);
        take_scores(state, task.custom_measures);
    }
}

}  // namespace

Experiment read_experiment(const std::string& file, Diagnostics& diagnostics) {
    Experiment experiment;
    try {
        read_fields(experiment, read_yaml(file), diagnostics);
        if (experiment.task)
            read_files(*experiment.task, std::filesystem::path(file).parent_path().string(),
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
    if (root.find("items") != nullptr) return FileKind::form;
    if (root.find("devices") != nullptr) return FileKind::rig;
    if (root.find("traits") != nullptr || root.find("based_on") != nullptr)
        return FileKind::population;
    return FileKind::unknown;
}

}  // namespace dihaptic::task
