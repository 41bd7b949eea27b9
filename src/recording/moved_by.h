// Records who moved the hand in a session. All files, tables and pages take this information from
// here, so that simulated data are never mistaken for a person's.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "base/table.h"

namespace dihaptic::recording {

enum class Mover {
    not_recorded,       ///< an earlier version did not record it
    devices,            ///< a person held the devices
    mouse,              ///< a person moved simulated devices by mouse
    recorded_movement,  ///< a recorded movement pulled the fingers of simulated devices
    script,             ///< the file's script moved simulated devices
    simulated_person    ///< a simulated person moved simulated devices
};
constexpr auto enum_names(Mover) {
    return std::array{"not_recorded",      "devices", "mouse",
                      "recorded_movement", "script",  "simulated_person"};
}

struct MovedBy {
    Mover mover = Mover::not_recorded;
    // for a simulated person
    std::string program;     ///< program that simulated the person: name and version
    std::string population;  ///< population that the person was drawn from
    std::string seed;        ///< seed with which the person was drawn

    /// Whether a person moved the hand, at a device or by mouse.
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

/// The columns `simulated` and `moved_by`, which come last in each table about people.
extern const std::array<Table::Column, 2> kMovedByColumns;

/// Adds these columns to the table, with the same values in all rows.
Table marked(Table table, const MovedBy& by);

/// Prefix of the identifiers of simulated people.
constexpr const char* kSimulatedPrefix = "sim-";

/// Identifier of a simulated person: `id` with the prefix "sim-", which is added if it is missing;
/// "sim-001" if `id` is empty.
std::string simulated_id(const std::string& id);

}  // namespace dihaptic::recording
