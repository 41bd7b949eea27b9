#include "recording/moved_by.h"

#include <fmt/format.h>

namespace dihaptic::recording {

const std::array<Table::Column, 2> kMovedByColumns{
    {{"simulated", "yes: no person took part; no: a person took part; empty: not recorded"},
     {"moved_by",
      "source of the hand's movement: devices or mouse (a person), recorded_movement, script, "
      "simulated_person; empty: not recorded"}}};

std::string MovedBy::describe() const {
    switch (mover) {
        case Mover::devices:
            return "A person held the devices.";
        case Mover::mouse:
            return "A person moved simulated devices by mouse.";
        case Mover::recorded_movement:
            return "Simulated: a recorded movement pulled the fingers of simulated devices. No "
                   "person took part.";
        case Mover::script:
            return "Simulated: the file's script moved the hand. No person took part.";
        case Mover::simulated_person:
            return fmt::format(
                "Simulated: each hand was moved by a simulated person ({}, population {}, seed "
                "{}). No person took part.",
                program, population, seed);
        case Mover::not_recorded:
            break;
    }
    return "Who moved the hand was not recorded.";
}

Table marked(Table table, const MovedBy& by) {
    table.columns.insert(table.columns.end(), kMovedByColumns.begin(), kMovedByColumns.end());
    for (std::vector<Table::Cell>& row : table.rows) {
        row.emplace_back(by.simulated());
        row.emplace_back(by.name());
    }
    return table;
}

std::string simulated_id(const std::string& id) {
    if (id.starts_with(kSimulatedPrefix)) return id;
    return kSimulatedPrefix + (id.empty() ? "001" : id);
}

}  // namespace dihaptic::recording
