// The measures that papers report, by name: what a task may list under `measures`, what each needs,
// and of which movement they are taken. src/analysis/measures computes them, and
// docs/measures-of-behaviour.md has the equations.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"
#include "base/table.h"
#include "rows/row_file.h"
#include "task/file/ref.h"

namespace dihaptic::scene {
struct Scene;
}

namespace dihaptic::task {

struct TaskPlan;

/// A column of trials.csv; units as in base/figure.h.
struct MeasureColumn {
    const char* name = nullptr;
    const char* unit = "";
    const char* what = "";
};

struct MeasureRow {
    /// What the task must say for the measure: of what movement it is taken; a channel; a field
    /// whose ideal force there is; an object and two fingers; a state that begins with a load step.
    /// begun: the movement need not have ended.
    enum Needs : unsigned { movement = 1, channel = 2, ideal = 4, grip = 8, step = 16, begun = 32 };
    const char* name;
    unsigned needs;
    const char* source;
    std::array<MeasureColumn, 5> columns;  ///< the last ones may be empty
};

inline constexpr unsigned kMoves = MeasureRow::movement;
inline constexpr unsigned kInChannel = MeasureRow::movement | MeasureRow::channel;
inline constexpr MeasureRow kMeasureTable[] = {
    {"reaction_time",
     kMoves | MeasureRow::begun,
     "Georgopoulos et al. 1981",
     {{{"reaction_time", "s", "from the go signal to the movement's onset"}}}},
    {"movement_time",
     kMoves,
     "Georgopoulos et al. 1981",
     {{{"movement_time", "s", "from onset to end"}}}},
    {"peak_speed", kMoves, "Flash and Hogan 1985", {{{"peak_speed", "m/s", "largest speed"}}}},
    {"time_of_peak_speed",
     kMoves,
     "Flash and Hogan 1985",
     {{{"time_of_peak_speed", "s", "from onset"}}}},
    {"path_length",
     kMoves,
     "Flash and Hogan 1985",
     {{{"path_length", "mm", "length of the path from onset to end"}}}},
    {"lateral_deviation",
     kMoves,
     "Shadmehr and Mussa-Ivaldi 1994",
     {{{"lateral_deviation", "mm", "from the straight line, largest by size; positive: left of it"},
       {"lateral_deviation_at_peak_speed", "mm", "from the straight line"},
       {"lateral_deviation_area_mm2", "mm2", "between path and line, with its sign"}}}},
    {"end_point_error",
     kMoves,
     "Gordon et al. 1994",
     {{{"end_point_error", "mm", "distance from the target's centre at the movement's end"},
       {"end_point_extent_error", "mm", "its part along the line; positive: too far"},
       {"end_point_lateral_error", "mm", "its part across; positive: left of the line"}}}},
    {"initial_direction",
     kMoves | MeasureRow::begun,
     "Krakauer et al. 2000",
     {{{"initial_direction", "deg", "soon after onset, from the straight line, about the axis"}}}},
    {"spectral_arc_length",
     kMoves,
     "Balasubramanian et al. 2015",
     {{{"spectral_arc_length", "1", "of the speed; nearer to 0: smoother"}}}},
    {"channel_force",
     kInChannel,
     "Scheidt et al. 2000",
     {{{"channel_force", "N", "of the hand on the channel, largest by size; positive: to the left"},
       {"channel_force_at_peak_speed", "N", "of the hand on the channel"},
       {"channel_force_impulse_Ns", "N*s", "its integral from onset to end"}}}},
    {"adaptation_index",
     kInChannel | MeasureRow::ideal,
     "Smith et al. 2006",
     {{{"adaptation_index", "1", "slope of channel force on ideal force, through zero"},
       {"adaptation_index_slope", "1", "slope of the line with an intercept"},
       {"adaptation_index_offset", "N", "that intercept"},
       {"adaptation_index_r2", "1", "share of the channel force's variance that the line has"},
       {"field_share", "1", "of the ideal field that acted; empty in a channel"}}}},
    {"grip_onset",
     MeasureRow::grip,
     "Johansson and Westling 1984",
     {{{"grip_onset", "s", "from the go signal to the first digit's touch"}}}},
    {"load_onset",
     MeasureRow::grip,
     "Johansson and Westling 1984",
     {{{"load_onset", "s", "from the go signal until the first digit carries load"}}}},
    {"peak_grip",
     MeasureRow::grip,
     "Johansson and Westling 1988",
     {{{"peak_grip_in_lift", "N", "largest grip force from touch to lowering"},
       {"peak_grip_rate", "N/s", "largest before lift-off"},
       {"peak_load_rate", "N/s", "largest before lift-off"}}}},
    {"grip_load_r",
     MeasureRow::grip,
     "Flanagan and Wing 1993",
     {{{"grip_load_r", "1", "r of the rates of grip and load while loading"}}}},
    {"grip_load_lag",
     MeasureRow::grip,
     "Flanagan and Wing 1993",
     {{{"grip_load_lag", "s", "shift of grip with the largest r; positive: grip follows load"}}}},
    {"safety_margin",
     MeasureRow::grip,
     "Westling and Johansson 1984",
     {{{"safety_margin", "1", "share of the static grip beyond what friction needs"}}}},
    {"grip_latency",
     MeasureRow::grip | MeasureRow::step,
     "Cole and Abbs 1988",
     {{{"grip_latency", "s", "from the load step until grip force answers"}}}},
};

/// The row of that name; null if there is none.
const MeasureRow* measure_row(const std::string& name);
/// The columns of a measure, as files have them.
std::vector<Table::Column> columns_of_measure(const MeasureRow& row);
/// The column as files name it whose name without its unit is `error`; "" if none of the measures
/// has it.
std::string error_column(const std::vector<std::string>& measures, const std::string& error);
/// Those of all measures, and kNotMeasured.
std::vector<Table::Column> measure_columns();
/// Name of the column that says what of a trial's measures is missing, and why.
inline constexpr const char* kNotMeasured = "not_measured";
Table::Column not_measured_column();

/// What of the values in an attempt's ticks is the measure.
enum class Take { first, last, min, max, mean };
constexpr auto enum_names(Take) {
    return std::array{"first", "last", "min", "max", "mean"};
}

/// A measure of a task's own.
struct State;

struct OwnMeasure {
    std::string name;  ///< its column in trials.csv, with the unit
    std::string of;    ///< an expression, evaluated in each tick
    Take take = Take::max;
    RefList<State> during;  ///< empty: all
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says(
              "Its column in trials.csv, with the unit, e.g. squeeze_N."));
        v("of", of, Field::text().required().says("An expression, evaluated in each tick."));
        v("take", take, Field::text().required().says("Which of its values is reported."));
        v("during", during, says("States in whose ticks it is taken; left out: all."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// What movement a task's measures are taken of. What is left out is taken from `reach`.
struct Movement {
    std::string of;                   ///< finger, body, or `hand`: the middle of all handles
    std::string from;                 ///< region
    std::string to;                   ///< region
    std::vector<std::string> during;  ///< states
    std::string go;    ///< state that begins with the go signal; empty: the first of `during`
    std::string step;  ///< state that begins with a load step
    /// Speed above which it moves: this, or else this share of its peak.
    std::optional<double> onset_speed;  ///< [m/s]
    double onset_share = 0.05;
    double end_still = 0;          ///< time for which it has to be slow to have ended [s]
    double direction_after = 0.1;  ///< time from onset at which the initial direction is taken [s]
    std::optional<Vec3> axis;      ///< as ReachMeasure::axis
    std::string ideal;  ///< perturbation whose field is the ideal force; empty: the first
    /// Column of a listed measure, without its unit: the error that shows what is not yet learned
    /// of a perturbation. Adaptation is fitted to it.
    std::string error;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("of", of,
          says("Finger, body or hand (the middle of all handles) whose movement it "
               "is; left out, the scene's first finger."));
        v("from", from, says("Region that the straight line begins in."));
        v("to", to, says("Region that it leads to."));
        v("during", during,
          says("States of the movement, from when the first is entered until they are left."));
        v("go", go, says("State that begins with the go signal; left out, the first of these."));
        v("step", step, says("State that begins with a load step."));
        v("onset_speed", onset_speed,
          Field::of(Quantity::speed)
              .within(1e-3, 10)
              .says("Speed above which it moves; left out, onset_share holds."));
        v("onset_share", onset_share,
          Field::number().within(0.001, 0.9).says("Share of its peak speed above which it moves."));
        v("end_still", end_still,
          Field::of(Quantity::time)
              .within(0, 10)
              .says("Time for which it has to be slow to have ended."));
        v("direction_after", direction_after,
          Field::of(Quantity::time)
              .within(1e-3, 10)
              .says("Time from onset at which the initial direction is taken."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Axis from whose tip left is left of the line; left out, that of reach."));
        v("ideal", ideal,
          says("Perturbation whose field the channel's force is compared with; left "
               "out, the first with a viscous or curl field."));
        v("error", error,
          says("Figure of a listed measure to which adaptation is fitted, by condition."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};
inline constexpr const char* kHand = "hand";

/// A trial's movement, as trial-list.csv freezes it.
struct MovementPlan {
    Vec3 from_W = Vec3::Zero();
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();
    int channel = 0;            ///< 1: a channel holds it
    double field_share = 0;     ///< the trial's field over the ideal one; NaN in a channel
    Mat3 ideal = Mat3::Zero();  ///< force of the ideal field over velocity [N*s/m]

    /// Unit vectors along the line, and across it to the left, seen from the axis' tip; NaN where
    /// they are not defined.
    Vec3 along_W() const { return (to_W - from_W).normalized(); }
    Vec3 left_W() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        rows::visit_vector(v, "movement_from", f.from_W, "mm", "where its straight line begins");
        rows::visit_vector(v, "movement_to", f.to_W, "mm", "where that leads");
        rows::visit_vector(v, "movement_axis", f.axis_W, "1", "from whose tip left is left of it");
        v("movement_channel", f.channel, "1", "1: a channel holds it");
        v("movement_field_share", f.field_share, "1",
          "the trial's field over the ideal one; empty in a channel");
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                v(std::string("movement_ideal_") + "xyz"[row] + "xyz"[column], f.ideal(row, column),
                  "N*s/m", "force of the ideal field over velocity");
        }
    }
};

struct Task;
/// The task's movement, with what it leaves out. `first_finger`: whose it is otherwise.
Movement movement_of(const Task& task, const std::string& first_finger);

/// Checks the names of a task's measures, and that the task says what they need.
void check_measures(const TaskPlan& plan, const scene::Scene& scene, Diagnostics& diagnostics);

/// Adds a column for each number of the trials' movements to a list with a row for each trial.
void add_movements(Table& list, const TaskPlan& plan, const scene::Scene& scene);
/// Name of the first of these columns; those on reaches stand before it.
inline constexpr const char* kFirstMovementColumn = "movement_from_x_mm";
/// Reads them by trial; none if the task's measures need no movement.
std::vector<MovementPlan> read_movements(const std::string& file);

}  // namespace dihaptic::task
