#include <fmt/format.h>

#include <filesystem>

#include "base/output.h"
#include "base/text_file.h"
#include "command.h"
#include "session/file_schemas.h"

namespace dihaptic::cli {
namespace {

void write_schema(const session::FileSchema& schema, const std::string& folder) {
    write_file(schema.json(), fmt::format("{}/{}.json", folder, schema.name));
}

void make_schemas(const std::string& kind, const std::string& folder) {
    if (folder.empty()) {
        if (kind.empty())
            throw Error("neither a kind nor a folder is given",
                        "Name a kind of file (dihaptic schema scene), or a folder for the schemas "
                        "of all kinds (--out).");
        fmt::print("{}", session::file_schema(kind).json());
        return;
    }
    make_folders(folder, "");
    if (!kind.empty()) {
        write_schema(session::file_schema(kind), folder);
        return;
    }
    for (const session::FileSchema& schema : session::file_schemas()) write_schema(schema, folder);
}

}  // namespace

void add_schema(CLI::App& app) {
    auto* command = app.add_subcommand(
        "schema",
        "Print the JSON Schema of a kind of file, with which editors complete and check such "
        "files");
    auto kind = std::make_shared<std::string>();
    auto folder = std::make_shared<std::string>();
    std::string kinds;
    for (const session::FileSchema& schema : session::file_schemas())
        kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", schema.name);
    command->add_option("KIND", *kind, "kind of file: " + kinds);
    command->add_option("-o,--out", *folder,
                        "folder to which it is written, as KIND.json; without KIND, all schemas");
    command->footer(
        "\nExamples:\n  dihaptic schema experiment > experiment.json\n  dihaptic schema --out "
        "schemas    the schemas of all kinds of files");
    command->callback([kind, folder] { make_schemas(*kind, *folder); });
}

}  // namespace dihaptic::cli
