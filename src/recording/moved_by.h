// Who moved the hand in a session: the one home of that fact. Files, tables and pages take it from
// here, so that what a simulation left is never taken for a person's.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "base/table.h"

namespace dihaptic::recording {

enum class Mover {
    not_recorded,       ///< by a program that did not write it down
    devices,            ///< a person held the devices
    mouse,              ///< a person moved simulated devices by mouse
    recorded_movement,  ///< pulled the fingers of simulated devices
    script,             ///< of the file
    simulated_person
};
constexpr auto enum_names(Mover) {
    return std::array{"not_recorded",      "devices", "mouse",
                      "recorded_movement", "script",  "simulated_person"};
}

struct MovedBy {
    Mover mover = Mover::not_recorded;
    // of a simulated person
    std::string program;     ///< that simulated it: name and version
    std::string population;  ///< that it was drawn from
    std::string seed;        ///< by which

    /// Whether there was a person, at a device or at a mouse.
    bool person() const { return mover == Mover::devices || mover == Mover::mouse; }
    bool known() const { return mover != Mover::not_recorded; }
    /// "yes", "no"; "" when it was not recorded.
    std::string simulated() const { return !known() ? "" : person() ? "no" : "yes"; }
    /// "script"; "" when it was not recorded.
    std::string name() const { return known() ? std::string(enum_name(mover)) : ""; }
    /// A sentence.
    std::string describe() const;

    template <class Visitor>
    void visit(Visitor& v) {
        v("mover", mover);
        v("program", program);
        v("population", population);
        v("seed", seed);
    }
};

/// The columns `simulated` and `moved_by`, which stand last in each table of people.
extern const std::array<Table::Column, 2> kMovedByColumns;

/// The table with these columns, the same in all of its rows.
Table marked(Table table, const MovedBy& by);

/// What identifiers of simulated people begin with.
constexpr const char* kSimulatedPrefix = "sim-";

/// Identifier of a simulated person: "sim-001" when none is given; what does not begin with "sim-"
/// gets that before it.
std::string simulated_id(const std::string& id);

}  // namespace dihaptic::recording
