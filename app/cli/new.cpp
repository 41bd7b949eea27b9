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
void check_name(const std::string& name) {
    const bool plain = std::all_of(name.begin(), name.end(), is_usual);
    if (plain && !name.empty() && name.front() != '-' && name.front() != '.') return;
    std::string near = name;
    std::replace_if(
        near.begin(), near.end(), [](char c) { return !is_usual(c); }, '-');
    near.erase(0, near.find_first_not_of("-."));
    throw Error(fmt::format("'{}' is not a valid name for a study", shortened(name)),
                fmt::format("Use letters, digits, '-' and '_': dihaptic new study {}.",
                            near.empty() ? "my-study" : near));
}

/// Returns the path of the new study. Throws Error when the study cannot be made there.
fs::path place_of(std::string path) {
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    const fs::path folder(path);
    check_name(folder.filename().string());
    std::error_code failed;
    if (fs::exists(fs::symlink_status(folder, failed)))
        throw Error({path, 0}, "", "already exists", "Choose another name.");
    const fs::path above = folder.parent_path();
    if (above.empty() || fs::is_directory(above, failed)) return folder;
    if (fs::exists(above, failed))
        throw Error({above.string(), 0}, "", "is not a folder", "Name a folder for the study.");
    throw Error({above.string(), 0}, "", "does not exist",
                fmt::format("Make it first: mkdir -p '{}'.", above.string()));
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
        const std::string line = file.schema == nullptr ? "" : session::schema_line(file.schema);
        write_file(line + std::string(file.text), fmt::format("{}/{}", study->path(), file.name));
    }
    study->keep();
}

void new_study(const std::string& path) {
    const fs::path folder = place_of(path);
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

}  // namespace

void add_new(CLI::App& app) {
    auto* command = app.add_subcommand("new", "Make your own files to start with: a whole study");
    command->require_subcommand(1);
    command->footer("\nExample:\n  dihaptic new study my-study");
    auto* study = command->add_subcommand(
        "study", "Make a folder with scene, rig, experiment and README.md, to be edited");
    auto name = std::make_shared<std::string>();
    study->add_option("NAME", *name, "the folder, which must not exist yet")->required();
    study->footer("\nExample:\n  dihaptic new study my-study");
    study->callback([name] { new_study(*name); });
}

}  // namespace dihaptic::cli
