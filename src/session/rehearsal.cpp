#include "session/rehearsal.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/field_writer.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/temporary_folder.h"
#include "base/text_file.h"
#include "session/frozen_inputs.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& folder) {
    return folder + "/rehearsal.yaml";
}

/// Describes the first value in which two documents differ: "task.yaml, states, 2, name: a there, b
/// here".
std::string difference(const Node& there, const Node& here, const std::string& path) {
    const auto inner = [&](const std::string& key) {
        return path.empty() ? key : path + ", " + key;
    };
    if (there.kind != here.kind || there.scalar != here.scalar) {
        const auto text = [](const Node& node) {
            if (node.kind == Node::Kind::null) return std::string("nothing");
            return node.kind == Node::Kind::scalar ? shortened(node.scalar) : "a list";
        };
        return fmt::format("{}: {} there, {} now", path, text(there), text(here));
    }
    for (size_t i = 0; i < std::max(there.items.size(), here.items.size()); ++i) {
        const Node none;
        const Node& a = i < there.items.size() ? there.items[i] : none;
        const Node& b = i < here.items.size() ? here.items[i] : none;
        const std::string found = difference(a, b, inner(number_text(i + 1)));
        if (!found.empty()) return found;
    }
    for (const Node::Entry& entry : there.entries) {
        const Node* other = here.find(entry.key);
        const std::string found =
            difference(entry.value, other == nullptr ? Node{} : *other, inner(entry.key));
        if (!found.empty()) return found;
    }
    for (const Node::Entry& entry : here.entries) {
        if (there.find(entry.key) == nullptr)
            return difference(Node{}, entry.value, inner(entry.key));
    }
    return "";
}

/// Whether a folder contains the folders of simulated people.
bool has_people(const std::string& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (is_there((entry.path() / "person.yaml").string())) return true;
    }
    return false;
}

}  // namespace

std::string person_id(int n) {
    return fmt::format("sim-{:03d}", n);
}

int shard_of(int n, int shards) {
    return (n - 1) % shards + 1;
}

Rehearsal rehearsal_of(const Plan& plan, Node population) {
    Rehearsal out;
    out.program = recording::program_version();
    out.experiment = plan.title;
    out.seed = number_text(plan.seed);
    out.population = std::move(population);
    out.inputs = Node::mapping();
    const TemporaryFolder scratch;
    const auto folder = recording::SessionFolder::create(scratch.path(), "inputs");
    for (const recording::InputFile& input : freeze_inputs(plan, folder)) {
        if (input.file == "trial-list.csv") continue;  // this file differs from person to person
        const bool text = fs::path(input.file).extension() == ".yaml";
        out.inputs.set(input.file,
                       text ? read_yaml(folder.file(input.file)) : Node::of(input.checksum));
    }
    return out;
}

Rehearsal read_rehearsal(const std::string& folder) {
    if (!is_there(file_of(folder))) {
        throw Error({folder, 0}, "", "does not identify its rehearsal: no rehearsal.yaml",
                    "Rehearse again, into another folder: --out FOLDER.");
    }
    Rehearsal out;
    Diagnostics diagnostics;
    read_fields(out, read_yaml(file_of(folder)), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

std::string difference(const Rehearsal& there, const Rehearsal& here) {
    Rehearsal a = there;
    Rehearsal b = here;
    a.asked = b.asked;
    return difference(write_fields(a), write_fields(b));
}

std::string difference(const Node& there, const Node& here) {
    // compared as text, so that a number read from a file equals the same number in memory
    return difference(parse_yaml(to_yaml(there), "there"), parse_yaml(to_yaml(here), "here"), "");
}

void claim(const std::string& folder, const Rehearsal& rehearsal) {
    fs::create_directories(folder);
    if (is_there(file_of(folder)) || has_people(folder)) {
        const Rehearsal there = read_rehearsal(folder);
        const std::string other = difference(there, rehearsal);
        if (!other.empty()) {
            throw Error({folder, 0}, "", "is another rehearsal: " + other,
                        "Choose another folder (--out FOLDER), or remove this one.");
        }
        if (there.asked == rehearsal.asked)
            return;  // e.g. for all shards of a cluster job after the first
    }
    Rehearsal copy = rehearsal;
    write_file(to_yaml(write_fields(copy)), file_of(folder));
}

}  // namespace dihaptic::session
