// Records who or what moved the hand in a session. All files, tables and pages take this
// information from here, so that simulated data are never mistaken for data from a person.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "base/table.h"

namespace dihaptic::recording {

enum class Mover {
    not_recorded,       ///< recorded by an earlier version, which did not store the mover
    devices,            ///< a person held the devices
    mouse,              ///< a person moved simulated devices with the mouse
    recorded_movement,  ///< a recorded movement pulled the fingers of simulated devices
    script,             ///< the script in the file moved simulated devices
    simulated_person    ///< a simulated person moved simulated devices
};
constexpr auto enum_names(Mover) {
    return std::array{"not_recorded",      "devices", "mouse",
                      "recorded_movement", "script",  "simulated_person"};
}

struct MovedBy {
    Mover mover = Mover::not_recorded;
    // for a simulated person
    std::string program;     ///< name and version of the program that simulated the person
    std::string population;  ///< population from which the person was drawn
    std::string seed;        ///< seed used to draw the person

    /// Whether a person moved the hand, either with a device or with the mouse.
    bool person() const { return mover == Mover::devices || mover == Mover::mouse; }
    bool known() const { return mover != Mover::not_recorded; }
    /// "yes" or "no"; "" if not recorded.
    std::string simulated() const { return !known() ? "" : person() ? "no" : "yes"; }
    /// Name of the mover, e.g. "script"; "" if not recorded.
    std::string name() const { return known() ? std::string(enum_name(mover)) : ""; }
    /// Describes the mover in a sentence.
    std::string describe() const;

    template <class Visitor>
    void visit(Visitor& v) {
        v("mover", mover);
        v("program", program);
        v("population", population);
        v("seed", seed, Field::number().at_least(0));
    }
};

/// The columns `simulated` and `moved_by`, which are the last columns of every table about people.
extern const std::array<Table::Column, 2> kMovedByColumns;

/// Appends these columns to the table, with the same values in every row.
Table marked(Table table, const MovedBy& by);

/// Prefix of the IDs of simulated people.
constexpr const char* kSimulatedPrefix = "sim-";

/// ID of a simulated person: `id` with the prefix "sim-", which is added if it is missing;
/// "sim-001" if `id` is empty.
std::string simulated_id(const std::string& id);

}  // namespace dihaptic::recording
