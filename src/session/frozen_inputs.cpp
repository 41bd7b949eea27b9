#include "session/frozen_inputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>

#include "base/field_table.h"
#include "base/text_file.h"
#include "scene/materials.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

/// Copies a file to the session's folder, and returns the name that it has there.
std::string copied(const fs::path& file, const std::string& kind, size_t number,
                   const recording::SessionFolder& folder) {
    std::string name = fmt::format("{}-{}-{}", kind, number, file.filename().string());
    fs::copy_file(file, folder.file(name));
    return name;
}

/// Copies the materials whose colours a mesh has beside the copy of the mesh, which is of that
/// name.
void freeze_materials(const scene::Mesh* mesh, const std::string& copy,
                      const recording::SessionFolder& folder, std::vector<std::string>& names) {
    if (mesh == nullptr || mesh->colours.empty() || mesh->materials.empty()) return;
    names.push_back(scene::materials_beside(copy));
    fs::copy_file(mesh->materials, folder.file(names.back()));
}

/// Copies the scene's meshes to the session's folder, and makes the scene name the copies.
std::vector<std::string> freeze_meshes(scene::Scene& scene, const std::string& from,
                                       const recording::SessionFolder& folder) {
    std::vector<std::string> names;
    size_t count = 0;
    const std::function<void(scene::Shape&)> freeze = [&](scene::Shape& shape) {
        for (scene::Part& part : shape.parts) freeze(part.shape);
        if (shape.kind != scene::ShapeKind::mesh) return;
        shape.file = copied(fs::path(from) / shape.file, "mesh", ++count, folder);
        names.push_back(shape.file);
        freeze_materials(shape.coloured.get(), shape.file, folder, names);
        if (!shape.concave) return;
        // a replay uses these pieces, even if another version would cut the mesh differently
        names.push_back(scene::pieces_file(shape.file));
        scene::write_pieces(shape.pieces, folder.file(names.back()));
    };
    for (scene::Body& body : scene.bodies) freeze(body.shape);
    for (scene::Finger& finger : scene.fingers) freeze(finger.shape);
    return names;
}

/// Copies the pictures that textures are, and makes the scene name the copies.
std::vector<std::string> freeze_textures(scene::Scene& scene, const std::string& from,
                                         const recording::SessionFolder& folder) {
    std::vector<std::string> names;
    for (scene::Body& body : scene.bodies) {
        if (!body.surface.texture || body.surface.texture->file.empty()) continue;
        std::string& file = body.surface.texture->file;
        file = copied(fs::path(from) / file, "texture", names.size() + 1, folder);
        names.push_back(file);
    }
    return names;
}

/// Copies the pictures and meshes that bodies are drawn with, and makes the scene name the copies.
/// A picture is copied once, whatever wears it.
std::vector<std::string> freeze_looks(scene::Scene& scene, const std::string& from,
                                      const recording::SessionFolder& folder) {
    std::vector<std::string> names;
    std::map<std::string, std::string> pictures;
    size_t meshes = 0;
    for (scene::Body& body : scene.bodies) {
        if (body.picture) {
            std::string& copy = pictures[body.picture->file];
            if (copy.empty()) {
                copy =
                    copied(fs::path(from) / body.picture->file, "picture", pictures.size(), folder);
                names.push_back(copy);
            }
            body.picture->file = copy;
        }
        if (body.seen) {
            std::string& file = body.seen->file;
            file = copied(fs::path(from) / file, "seen", ++meshes, folder);
            names.push_back(file);
            freeze_materials(body.seen->mesh.get(), file, folder, names);
        }
    }
    return names;
}

/// Copies the pictures of the task's pages to the session's folder, and makes the task name the
/// copies.
std::vector<std::string> freeze_pictures(task::Task& task, const recording::SessionFolder& folder) {
    std::vector<std::string> names;
    for (task::Block& block : task.blocks) {
        for (task::PageSpec& page : block.pages) {
            if (page.picture.empty()) continue;
            page.picture = copied(page.picture, "page", names.size() + 1, folder);
            names.push_back(page.picture);
        }
    }
    return names;
}

/// Copies the task's sound files to the session's folder, and makes the task name the copies.
std::vector<std::string> freeze_sounds(task::Task& task, const recording::SessionFolder& folder) {
    std::vector<std::string> names;
    for (task::SoundSpec& sound : task.sounds) {
        if (sound.file.empty()) continue;
        sound.file = copied(sound.file, "sound", names.size() + 1, folder);
        names.push_back(sound.file);
    }
    return names;
}

Table fault_table(const MovementReport& movement) {
    Table faults;
    faults.columns = {{"start_s", "last good frame before"},
                      {"end_s", "first good frame after"},
                      {"finger", "empty: all"},
                      {"fault", "what the tracker lost"},
                      {"line", "of movement.csv"},
                      {"distance_mm", "between the good frames"}};
    for (const hand::Fault& fault : movement.faults) {
        faults.rows.push_back(
            {fault.start, fault.end,
             fault.finger < 0 ? "" : movement.fingers[static_cast<size_t>(fault.finger)],
             std::string(enum_name(fault.kind)), static_cast<double>(fault.line),
             fault.distance * 1e3});
    }
    return faults;
}

}  // namespace

std::vector<recording::InputFile> freeze_inputs(const Plan& plan,
                                                const recording::SessionFolder& folder) {
    scene::Scene scene = plan.scene;
    scene.settings = {};  // settings.yaml has the resolved settings
    scene.hand = write_fields(plan.hand);
    std::vector<std::string> names = freeze_meshes(scene, plan.scene_folder, folder);
    const std::vector<std::string> textures = freeze_textures(scene, plan.scene_folder, folder);
    names.insert(names.end(), textures.begin(), textures.end());
    const std::vector<std::string> looks = freeze_looks(scene, plan.scene_folder, folder);
    names.insert(names.end(), looks.begin(), looks.end());
    write_file(to_yaml(write_fields(scene)), folder.file("scene.yaml"));
    rig::Rig rig = plan.rig;
    if (rig.calibrated) {
        rig.calibration = "calibration.yaml";
        write_file(to_yaml(write_fields(*rig.calibrated)), folder.file(rig.calibration));
        names.push_back(rig.calibration);
    }
    for (rig::Display& display : rig.displays) {
        if (!display.registered) continue;
        display.registration = fmt::format("registration-{}.yaml", names.size());
        write_file(to_yaml(write_fields(*display.registered)), folder.file(display.registration));
        names.push_back(display.registration);
    }
    write_file(to_yaml(write_fields(rig)), folder.file("rig.yaml"));
    write_file(to_yaml(write_fields(plan.settings)), folder.file("settings.yaml"));
    write_csv(list_fields(plan.settings, plan.origins), folder.file("settings.csv"));
    for (const char* name : {"scene.yaml", "rig.yaml", "settings.yaml"}) names.emplace_back(name);
    if (plan.movement) {
        fs::copy_file(plan.movement->file, folder.file("movement.csv"));
        names.emplace_back("movement.csv");
        write_csv(fault_table(*plan.movement), folder.file("movement-faults.csv"));
    }
    if (plan.task) {
        task::Task task = plan.task->task;
        const std::vector<std::string> pictures = freeze_pictures(task, folder);
        names.insert(names.end(), pictures.begin(), pictures.end());
        const std::vector<std::string> sounds = freeze_sounds(task, folder);
        names.insert(names.end(), sounds.begin(), sounds.end());
        write_file(to_yaml(write_fields(task)), folder.file("task.yaml"));
        write_csv(task::frozen_list(*plan.task, plan.scene), folder.file("trial-list.csv"));
        names.insert(names.end(), {"task.yaml", "trial-list.csv"});
        if (!plan.task->task.procedures.empty())
            write_csv(task::procedure_table(*plan.task), folder.file("procedures.csv"));
    }
    if (!plan.person.empty()) {
        write_file(plan.person, folder.file("person.yaml"));
        names.emplace_back("person.yaml");
    }
    if (!plan.resumes.empty())
        fs::copy_file(plan.resumes + "/trials.csv", folder.file("trials-before.csv"));
    std::vector<recording::InputFile> inputs;
    inputs.reserve(names.size());
    for (const std::string& name : names) inputs.push_back(folder.input(name));
    return inputs;
}

}  // namespace dihaptic::session
