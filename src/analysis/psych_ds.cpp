#include "analysis/psych_ds.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/bids/motion.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json variable(const Table::Column& column) {
    Json out{{"@type", "PropertyValue"}, {"name", column.name}};
    if (!column.description.empty()) out["description"] = column.description;
    if (!column.unit.empty()) out["unitText"] = column.unit;
    return out;
}

Json dataset(const PsychDs& data, const std::vector<Table::Column>& columns) {
    Json variables = Json::array();
    for (const Table::Column& column : columns) variables.push_back(variable(column));
    Json out{{"@context", "https://schema.org/"},
             {"@type", "Dataset"},
             {"name", data.simulated ? "Simulation: " + data.title : data.title},
             {"description", data.description}};
    for (const std::string& name : data.authors)
        out["author"].push_back({{"@type", "Person"}, {"name", name}});
    out["variableMeasured"] = variables;
    return out;
}

/// Returns the columns of all tables without duplicates, each with the description from the first
/// table that has the column. A file next to each table has that table's own descriptions.
std::vector<Table::Column> all_columns(const std::vector<TextTable>& tables) {
    std::vector<Table::Column> out;
    std::set<std::string> known;
    for (const TextTable& table : tables) {
        for (const Table::Column& column : table.columns) {
            if (known.insert(column.name).second) out.push_back(column);
        }
    }
    return out;
}

std::string readme(const PsychDs& data, const std::vector<std::string>& files) {
    std::string out = "# " + data.title + "\n\n";
    if (data.simulated)
        out +=
            "THIS DATA SET IS A SIMULATION. No person took part in it: simulated people moved "
            "the hand.\n\n";
    out += data.description +
           "\n\nEach file in `data` is a table with a header. The JSON file next to it gives the "
           "unit and the meaning of each\nof its columns. The columns `id` and `group` name the "
           "participant and the group in all tables.\n\n";
    for (const std::string& file : files) out += fmt::format("- `data/{}`\n", file);
    return out +
           "\nComplete authors, licence and funding in "
           "`dataset_description.json` before you share the\ndata.\n\nMade by " +
           data.program + " with `dihaptic export`.\n";
}

}  // namespace

std::vector<std::string> write_psych_ds(const PsychDs& data, const std::string& folder) {
    std::vector<TextTable> tables;
    for (const TextTable& table : data.tables) {
        if (!table.rows.empty()) tables.push_back(table);
    }
    if (tables.empty())
        throw Error({folder, 0}, "", "would contain no data", "Run or rehearse a session first.");
    const fs::path whole = (fs::path(folder) / "").parent_path();
    if (fs::exists(fs::symlink_status(whole)))
        throw Error({folder, 0}, "", "exists",
                    "Name another folder, or remove this one: the data set is made as a whole.");
    if (whole.has_parent_path()) fs::create_directories(whole.parent_path());
    remove_dead_parts(whole.string());
    Output making(whole.string());
    const std::string data_folder = making.path() + "/data";
    fs::create_directories(data_folder);
    std::vector<std::string> files;
    for (const TextTable& table : tables) {
        const std::string stem =
            fmt::format("study-{}_description-{}_data", bids::label(data.study),
                        bids::label(fs::path(table.name).stem().string()));
        write_file(to_csv(table), data_folder + "/" + stem + ".csv");
        write_file(dataset(data, table.columns).dump(2) + "\n", data_folder + "/" + stem + ".json");
        files.push_back(stem + ".csv");
    }
    write_file(dataset(data, all_columns(tables)).dump(2) + "\n",
               making.path() + "/dataset_description.json");
    write_file(readme(data, files), making.path() + "/README.md");
    write_file("# Changes\n\n- First version, made by " + data.program + ".\n",
               making.path() + "/CHANGES.md");
    making.keep();
    return files;
}

}  // namespace dihaptic::analysis
