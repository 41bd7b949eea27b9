#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "base/output.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "command.h"
#include "common/on_path.h"
#include "new_study.h"
#include "session/file_schemas.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct StudyFile {
    const char* name;
    std::string_view text;
    const char* schema = nullptr;  ///< schema with which editors complete and check the file
};

std::array<StudyFile, 4> study_files() {
    return {{{"scene.yaml", kStudyScene, "scene"},
             {"rig.yaml", kStudyRig, "rig"},
             {"experiment.yaml", kStudyExperiment, "experiment"},
             {"README.md", kStudyReadme}}};
}

bool is_usual(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
}

/// Checks that every shell takes the name literally. Throws an Error that suggests a similar name.
/// `kind`: what is made, as on the command line.
void check_name(const std::string& kind, const std::string& name) {
    const bool plain = std::all_of(name.begin(), name.end(), is_usual);
    if (plain && !name.empty() && name.front() != '-' && name.front() != '.') return;
    std::string near = name;
    std::replace_if(
        near.begin(), near.end(), [](char c) { return !is_usual(c); }, '-');
    near.erase(0, near.find_first_not_of("-."));
    throw Error(fmt::format("'{}' is not a valid name for {} {}", shortened(name),
                            kind == "experiment" ? "an" : "a", kind),
                fmt::format("Use letters, digits, '-' and '_': dihaptic new {} {}.", kind,
                            near.empty() ? "my-" + kind : near));
}

/// Returns the path of a new study or file. Throws Error when it cannot be made there.
fs::path place_of(const std::string& kind, std::string path) {
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    const fs::path folder(path);
    check_name(kind, folder.filename().string());
    std::error_code failed;
    if (fs::exists(fs::symlink_status(folder, failed)))
        throw Error({path, 0}, "", "already exists", "Choose another name.");
    const fs::path above = folder.parent_path();
    if (above.empty() || fs::is_directory(above, failed)) return folder;
    if (fs::exists(above, failed))
        throw Error({above.string(), 0}, "", "is not a folder",
                    fmt::format("Name a folder for the {}.", kind));
    throw Error({above.string(), 0}, "", "does not exist",
                fmt::format("Make it first: mkdir -p '{}'.", above.string()));
}

void write_study_file(const StudyFile& file, const std::string& path) {
    const std::string line = file.schema == nullptr ? "" : session::schema_line(file.schema);
    write_file(line + std::string(file.text), path);
}

/// Makes the folder under a temporary name first, so that an incomplete folder never has the final
/// name.
void make_study(const fs::path& folder) {
    std::optional<Output> study;
    try {
        study.emplace(folder.string());
    } catch (const Error&) {
        throw Error({folder.string(), 0}, "",
                    fmt::format("cannot be made: {}", std::strerror(errno)),
                    "First change to a folder of your own (cd), or name one: dihaptic new study "
                    "~/my-study.");
    }
    fs::create_directory(study->path());
    for (const StudyFile& file : study_files()) {
        write_study_file(file, fmt::format("{}/{}", study->path(), file.name));
    }
    study->keep();
}

void new_study(const std::string& path) {
    const fs::path folder = place_of("study", path);
    make_study(folder);
    std::vector<std::string> names;
    for (const StudyFile& file : study_files()) names.emplace_back(file.name);
    fmt::print("{}: {}\n", folder.string(), fmt::join(names, ", "));
    fmt::print("next: cd {}, and follow README.md from top to bottom\n",
               shell_file(folder.string()));
    const char* const paths = std::getenv("PATH");
    if (!app::shell_finds_program(paths == nullptr ? "" : paths))
        fmt::print("so that your shell finds dihaptic there: {}\n", app::path_command());
}

/// Returns the path of a new file of this kind. Throws Error when it cannot be made there.
fs::path file_place_of(const std::string& kind, const std::string& path) {
    const fs::path file = place_of(kind, path);
    if (file.extension() == ".yaml") return file;
    throw Error({path, 0}, "", "has no name that ends in .yaml",
                fmt::format("Give it such a name: dihaptic new {} {}.yaml.", kind,
                            fs::path(path).replace_extension().string()));
}

void new_scene(const std::string& path) {
    const fs::path file = file_place_of("scene", path);
    write_study_file(study_files()[0], file.string());
    fmt::print("{}\n", file.string());
}

/// Makes an experiment, and the scene and the rig that it names unless its folder has them.
void new_experiment(const std::string& path) {
    const fs::path file = file_place_of("experiment", path);
    const auto [scene, rig, experiment, readme] = study_files();
    if (file.filename() == scene.name || file.filename() == rig.name)
        throw Error({path, 0}, "", "is the name of a file that the experiment needs beside it",
                    "Choose another name: dihaptic new experiment experiment.yaml.");
    for (const StudyFile& used : {scene, rig}) {
        const fs::path beside = file.parent_path() / used.name;
        if (fs::exists(beside)) continue;
        write_study_file(used, beside.string());
        fmt::print("{}\n", beside.string());
    }
    write_study_file(experiment, file.string());
    fmt::print("{}\n", file.string());
}

}  // namespace

void add_new(CLI::App& app) {
    auto* command =
        app.add_subcommand("new", "Make your own files to start with: a whole study, or one file");
    command->require_subcommand(1);
    command->footer("\nExample:\n  dihaptic new study my-study");
    auto* study = command->add_subcommand(
        "study", "Make a folder with scene, rig, experiment and README.md, to be edited");
    auto name = std::make_shared<std::string>();
    study->add_option("NAME", *name, "the folder, which must not exist yet")->required();
    study->footer("\nExample:\n  dihaptic new study my-study");
    study->callback([name] { new_study(*name); });
    const auto add_file = [&](const char* kind, const char* what, auto make) {
        auto* one = command->add_subcommand(kind, what);
        auto file = std::make_shared<std::string>();
        one->add_option("FILE", *file, "the file, which must not exist yet")->required();
        one->footer(fmt::format("\nExample:\n  dihaptic new {} my-{}.yaml", kind, kind));
        one->callback([file, make] { make(*file); });
    };
    add_file("scene", "Make a scene: a fingertip above a table", new_scene);
    add_file("experiment",
             "Make an experiment, and beside it scene.yaml and rig.yaml unless they exist",
             new_experiment);
}

}  // namespace dihaptic::cli
