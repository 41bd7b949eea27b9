#include "session/frozen_inputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>

#include "base/checksum.h"
#include "base/field_table.h"
#include "base/installed.h"
#include "base/text_file.h"
#include "scene/materials.h"
#include "scene/relief_picture.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

Table fault_table(const MovementReport& movement) {
    Table faults;
    faults.columns = {{"start_s", "last good frame before"},
                      {"end_s", "first good frame after"},
                      {"finger", "empty: all"},
                      {"fault", "gaps in the tracking"},
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

/// Freezes the inputs of a plan, in the order in which they are listed.
class Freezer {
  public:
    Freezer(const Plan& plan, const recording::SessionFolder& folder)
        : plan_(plan), folder_(folder), scene_(plan.scene) {}

    std::vector<recording::InputFile> run() {
        scene_.settings = {};  // settings.yaml has the resolved settings
        scene_.hand = write_fields(plan_.hand);
        freeze_meshes();
        freeze_textures();
        freeze_looks();
        write_file(to_yaml(write_fields(scene_)), folder_.file("scene.yaml"));
        freeze_rig();
        write_file(to_yaml(write_fields(plan_.settings)), folder_.file("settings.yaml"));
        write_csv(list_fields(plan_.settings, plan_.origins), folder_.file("settings.csv"));
        for (const char* name : {"scene.yaml", "rig.yaml", "settings.yaml"}) list(name);
        freeze_movement();
        freeze_task();
        if (!plan_.person.empty()) {
            write_file(plan_.person, folder_.file("person.yaml"));
            list("person.yaml");
        }
        if (!plan_.resumes.empty())
            copy(plan_.resumes + "/trials.csv", "trials-before.csv", plan_.done_checksum);
        return std::move(inputs_);
    }

  private:
    void list(const std::string& name) { inputs_.push_back(folder_.input(name)); }

    /// Copies a file that was read for the plan into the session's folder. `read` is the checksum
    /// of the text that was read. Throws Error if the file has changed since then, because the
    /// session would differ from the files in its folder.
    void copy(const fs::path& file, const std::string& name, const std::string& read) const {
        copy_file(file, name);
        check_same(file, folder_.input(name).checksum, read);
    }
    void copy_file(const fs::path& file, const std::string& name) const {
        std::error_code failed;
        fs::copy_file(file, folder_.file(name), failed);
        if (failed) {
            throw Error({file.string(), 0}, "",
                        "cannot be copied to the session's folder: " + failed.message(),
                        "Check that it still exists, and that there is space on the disk of " +
                            folder_.path() + ".");
        }
    }
    static void check_same(const fs::path& file, const std::string& copied,
                           const std::string& read) {
        if (copied == read) return;
        throw Error({file.string(), 0}, "", "has changed while it was read for this session",
                    "Start again once no program is writing to it.");
    }

    /// Copies a file and adds it to the list of inputs. Returns the file's name in the session's
    /// folder.
    std::string freeze(const fs::path& file, const std::string& kind, size_t number,
                       const std::string& read) {
        std::string name = fmt::format("{}-{}-{}", kind, number, file.filename().string());
        copy(file, name, read);
        list(name);
        return name;
    }

    /// Freezes the materials that define a mesh's colours. They are stored next to the copy of the
    /// mesh, which has this name.
    void freeze_materials(const scene::Mesh* mesh, const std::string& name) {
        if (mesh == nullptr || mesh->colours.empty() || mesh->materials.empty()) return;
        const std::string beside = scene::materials_beside(name);
        copy(mesh->materials, beside, mesh->materials_checksum);
        list(beside);
    }

    /// Each of these functions replaces file names in the scene, or in the task, with the names of
    /// the copies.
    void freeze_meshes() {
        size_t count = 0;
        const std::function<void(scene::Shape&)> freeze_one = [&](scene::Shape& shape) {
            for (scene::Part& part : shape.parts) freeze_one(part.shape);
            if (shape.kind != scene::ShapeKind::mesh) return;
            shape.file = freeze(of_scene(shape.file), "mesh", ++count, shape.checksum);
            freeze_materials(shape.coloured.get(), shape.file);
            if (!shape.concave) return;
            // a replay uses these pieces, even if another version would cut the mesh differently
            const std::string pieces = scene::pieces_file(shape.file);
            scene::write_pieces(shape.pieces, folder_.file(pieces));
            list(pieces);
        };
        for (scene::Body& body : scene_.bodies) freeze_one(body.shape);
        for (scene::Finger& finger : scene_.fingers) freeze_one(finger.shape);
    }
    void freeze_textures() {
        size_t count = 0;
        for (scene::Body& body : scene_.bodies) {
            if (!body.surface.texture || body.surface.texture->file.empty()) continue;
            scene::Texture& texture = *body.surface.texture;
            texture.file =
                freeze(of_scene(texture.file), "texture", ++count, texture.picture->checksum());
        }
    }
    /// Each picture is copied only once, even if several bodies use it.
    void freeze_looks() {
        std::map<std::string, std::string> pictures;
        size_t meshes = 0;
        for (scene::Body& body : scene_.bodies) {
            if (body.picture) {
                std::string& name = pictures[body.picture->file];
                if (name.empty())
                    name = freeze(of_scene(body.picture->file), "picture", pictures.size(),
                                  body.picture->image->checksum);
                body.picture->file = name;
            }
            if (body.seen) {
                scene::SeenMesh& seen = *body.seen;
                seen.file = freeze(of_scene(seen.file), "seen", ++meshes, seen.mesh->checksum);
                freeze_materials(seen.mesh.get(), seen.file);
            }
        }
    }
    fs::path of_scene(const std::string& file) const { return named_in(plan_.scene_folder, file); }

    void freeze_rig() {
        rig::Rig rig = plan_.rig;
        if (rig.calibrated) {
            rig.calibration = "calibration.yaml";
            write_file(to_yaml(write_fields(*rig.calibrated)), folder_.file(rig.calibration));
            list(rig.calibration);
        }
        for (display::Display& display : rig.displays) {
            if (!display.registered) continue;
            display.registration = fmt::format("registration-{}.yaml", inputs_.size());
            write_file(to_yaml(write_fields(*display.registered)),
                       folder_.file(display.registration));
            list(display.registration);
        }
        write_file(to_yaml(write_fields(rig)), folder_.file("rig.yaml"));
    }

    void freeze_movement() {
        if (!plan_.movement) return;
        const MovementReport& movement = *plan_.movement;
        copy_file(movement.file, "movement.csv");
        // read_text_file() removes a byte order mark
        check_same(movement.file, checksum_of(read_text_file(folder_.file("movement.csv"))),
                   movement.checksum);
        list("movement.csv");
        write_csv(fault_table(movement), folder_.file("movement-faults.csv"));
    }

    void freeze_task() {
        if (!plan_.task) return;
        task::Task task = plan_.task->task;
        size_t pictures = 0;
        for (task::Block& block : task.blocks) {
            for (task::PageSpec& page : block.pages) {
                if (page.picture.empty()) continue;
                page.picture = freeze(page.picture, "page", ++pictures, page.checksum);
            }
        }
        size_t sounds = 0;
        for (task::SoundSpec& sound : task.sounds) {
            if (sound.file.empty()) continue;
            sound.file = freeze(sound.file, "sound", ++sounds, sound.checksum);
        }
        write_file(to_yaml(write_fields(task)), folder_.file("task.yaml"));
        write_csv(task::frozen_list(*plan_.task, plan_.scene), folder_.file("trial-list.csv"));
        list("task.yaml");
        list("trial-list.csv");
        if (!plan_.task->task.procedures.empty())
            write_csv(task::procedure_table(*plan_.task), folder_.file("procedures.csv"));
    }

    const Plan& plan_;
    const recording::SessionFolder& folder_;
    scene::Scene scene_;
    std::vector<recording::InputFile> inputs_;
};

}  // namespace

std::vector<recording::InputFile> freeze_inputs(const Plan& plan,
                                                const recording::SessionFolder& folder) {
    return Freezer(plan, folder).run();
}

}  // namespace dihaptic::session
