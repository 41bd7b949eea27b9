// Published measures by name: the entries for `measures` in a task, their requirements, and the
// movement that they analyse. src/analysis/measures computes them; docs/measures-of-behaviour.md
// gives the equations.
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
    /// Bounds of the column's plausible range, in its unit: a value outside it is due to the
    /// recording or the measure's rule, not the person, and is left out.
    double least = 0;
    double most = 0;
};

struct MeasureRow {
    /// Requirements of the measure: a movement; a channel; a field with an ideal force; an object
    /// and two fingers; a state that starts with a load step. begun: the movement need not have
    /// ended.
    enum Needs : unsigned { movement = 1, channel = 2, ideal = 4, grip = 8, step = 16, begun = 32 };
    const char* name;
    unsigned needs;
    const char* source;
    std::array<MeasureColumn, 5> columns;  ///< unused ones at the end are empty
};

inline constexpr unsigned kMoves = MeasureRow::movement;
inline constexpr unsigned kInChannel = MeasureRow::movement | MeasureRow::channel;
inline constexpr MeasureRow kMeasureTable[] = {
    {"reaction_time",
     kMoves | MeasureRow::begun,
     "Georgopoulos et al. 1981",
     {{{"reaction_time", "s", "from the go signal to the movement's onset", 0, 600}}}},
    {"movement_time",
     kMoves,
     "Georgopoulos et al. 1981",
     {{{"movement_time", "s", "from onset to end", 0.05, 600}}}},
    {"peak_speed",
     kMoves,
     "Flash and Hogan 1985",
     {{{"peak_speed", "m/s", "largest speed in the first stroke", 0, 20}}}},
    {"time_of_peak_speed",
     kMoves,
     "Flash and Hogan 1985",
     {{{"time_of_peak_speed", "s", "from onset to peak speed", 0, 600}}}},
    {"path_length",
     kMoves,
     "Flash and Hogan 1985",
     {{{"path_length", "mm", "length of the path from onset to end", 0, 1e5}}}},
    {"lateral_deviation",
     kMoves,
     "Shadmehr and Mussa-Ivaldi 1994",
     {{{"lateral_deviation", "mm",
        "deviation from the straight line at its first extreme; positive: to the left", -1000,
        1000},
       {"lateral_deviation_at_peak_speed", "mm", "deviation from the straight line at peak speed",
        -1000, 1000},
       {"lateral_deviation_area_mm2", "mm2", "signed area between path and line", -1e6, 1e6}}}},
    {"early_lateral_deviation",
     kMoves | MeasureRow::begun,
     "Krakauer et al. 2000",
     {{{"early_lateral_deviation", "mm",
        "deviation from the straight line shortly after onset; positive: to the left", -1000,
        1000}}}},
    {"largest_lateral_deviation",
     kMoves,
     "Mattar and Ostry 2007",
     {{{"largest_lateral_deviation", "mm",
        "deviation from the straight line that is largest by magnitude, also after the first "
        "stroke; positive: to the left",
        -1000, 1000}}}},
    {"end_point_error",
     kMoves,
     "Gordon et al. 1994",
     {{{"end_point_error", "mm", "distance from the target's centre at the end of the movement", 0,
        2000},
       {"end_point_extent_error", "mm",
        "component of the error along the line; positive: overshoot", -2000, 2000},
       {"end_point_lateral_error", "mm",
        "component of the error across the line; positive: to the left", -2000, 2000}}}},
    {"initial_direction",
     kMoves | MeasureRow::begun,
     "Krakauer et al. 2000",
     {{{"initial_direction", "deg",
        "angle from the straight line shortly after onset, about the axis", -180, 180}}}},
    {"spectral_arc_length",
     kMoves,
     "Balasubramanian et al. 2015",
     {{{"spectral_arc_length", "1", "spectral arc length of the speed; closer to 0: smoother", -100,
        0}}}},
    {"channel_force",
     kInChannel,
     "Scheidt et al. 2000",
     {{{"channel_force", "N",
        "largest force of the hand on the channel by magnitude; positive: to the left", -200, 200},
       {"channel_force_at_peak_speed", "N", "force of the hand on the channel at peak speed", -200,
        200},
       {"channel_force_impulse_Ns", "N*s", "integral of the channel force from onset to end", -1000,
        1000}}}},
    {"adaptation_index",
     kInChannel | MeasureRow::ideal,
     "Smith et al. 2006",
     {{{"adaptation_index", "1", "regression slope of channel force on ideal force, through zero",
        -3, 3},
       {"adaptation_index_slope", "1", "regression slope if an intercept is fitted too", -10, 10},
       {"adaptation_index_offset", "N", "intercept of the regression", -200, 200},
       {"adaptation_index_r2", "1",
        "share of the channel force's variance explained by the regression with an intercept", 0,
        1},
       {"field_share", "1", "share of the ideal field that acted; empty in a channel", -100,
        100}}}},
    {"grip_onset",
     MeasureRow::grip,
     "Johansson and Westling 1984",
     {{{"grip_onset", "s", "from the go signal to first contact by a digit", -600, 600}}}},
    {"load_onset",
     MeasureRow::grip,
     "Johansson and Westling 1984",
     {{{"load_onset", "s", "from the go signal until a digit first carries load", -600, 600}}}},
    {"peak_grip",
     MeasureRow::grip,
     "Johansson and Westling 1988",
     {{{"peak_grip_in_lift", "N", "largest grip force from touch to lowering", 0, 500},
       {"peak_grip_rate", "N/s", "largest rate of grip force before lift-off", 0, 1e5},
       {"peak_load_rate", "N/s", "largest rate of load force before lift-off", 0, 1e5}}}},
    {"grip_load_r",
     MeasureRow::grip,
     "Flanagan and Wing 1993",
     {{{"grip_load_r", "1", "correlation of the rates of grip and load force during loading", -1,
        1}}}},
    {"grip_load_lag",
     MeasureRow::grip,
     "Flanagan and Wing 1993",
     {{{"grip_load_lag", "s",
        "lag of grip with the largest correlation; positive: grip follows load", -0.1, 0.1}}}},
    {"safety_margin",
     MeasureRow::grip,
     "Westling and Johansson 1984",
     {{{"safety_margin", "1", "share of the static grip in excess of the minimum against slip", -5,
        1}}}},
    {"grip_latency",
     MeasureRow::grip | MeasureRow::step,
     "Cole and Abbs 1988",
     {{{"grip_latency", "s", "from the load step until grip force responds", 0, 10}}}},
};

/// The row with this name; null if there is none.
const MeasureRow* measure_row(const std::string& name);
/// The columns of a measure in files.
std::vector<Table::Column> columns_of_measure(const MeasureRow& row);
/// The name in files of the column called `error` without its unit; "" if none of the measures has
/// this column.
std::string error_column(const std::vector<std::string>& measures, const std::string& error);
/// The columns of all measures, and kNotMeasured.
std::vector<Table::Column> measure_columns();
/// Name of the column that lists a trial's missing measures with reasons.
inline constexpr const char* kNotMeasured = "not_measured";
Table::Column not_measured_column();

/// Statistic of the values in an attempt's ticks.
enum class Take { first, last, min, max, mean, median, sd, rms };
constexpr auto enum_names(Take) {
    return std::array{"first", "last", "min", "max", "mean", "median", "sd", "rms"};
}

struct State;

/// A custom measure of a task.
struct CustomMeasure {
    std::string name;  ///< the measure's column in trials.csv, with the unit
    std::string of;    ///< an expression, evaluated in each tick
    std::string when;  ///< condition that selects ticks; empty: all
    Take take = Take::max;
    std::optional<double> window;  ///< length of the moving means whose statistic is taken [s]
    RefList<State> during;         ///< empty: all
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says(
              "Name of the measure's column in trials.csv, with the unit, e.g. squeeze_N."));
        v("of", of, Field::text().required().says("Expression that is evaluated in each tick."));
        v("when", when,
          says("Condition that selects ticks, e.g. time_in_state > 2 s; all ticks if omitted."));
        v("take", take,
          Field::text().required().says("Statistic of the expression's values that is reported."));
        v("window", window,
          Field::of(Quantity::time)
              .within(1e-3, 600)
              .says("Time over which a moving mean is taken before the statistic; 'take: max' then "
                    "gives the highest value sustained for this time."));
        v("during", during, says("States in which the measure is evaluated; all if omitted."));
    }
};

/// The movement that a task's measures analyse. Keys omitted here are copied from `reach`.
struct Movement {
    std::string of;                   ///< finger, body, or `hand`: the middle of all handles
    std::string from;                 ///< region
    std::string to;                   ///< region
    std::vector<std::string> during;  ///< states
    std::string go;    ///< state that starts with the go signal; empty: the first of `during`
    std::string step;  ///< state that starts with a load step
    /// Speed that defines movement onset: absolute, or else a share of the peak speed.
    std::optional<double> onset_speed;  ///< [m/s]
    double onset_share = 0.05;
    double end_still = 0;           ///< time below that speed needed to end the movement [s]
    double direction_after = 0.1;   ///< from onset to the initial direction [s]
    double deviation_after = 0.15;  ///< from onset to the early lateral deviation [s]
    bool continues = false;         ///< whether movements can begin before their states
    std::optional<Vec3> axis;       ///< like ReachMeasure::axis
    std::string ideal;  ///< perturbation whose field defines the ideal force; empty: the first
    /// Column of a listed measure, without its unit: the error to which adaptation is fitted, since
    /// it shows how much of a perturbation is not yet learned.
    std::string error;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("of", of,
          says("Finger, body or hand (the middle of all handles) that moves; the scene's first "
               "finger if omitted."));
        v("from", from, says("Region at the start of the straight line."));
        v("to", to, says("Region at the end of the straight line."));
        v("during", during,
          says("States of the movement, which lasts from entry into the first until they are "
               "left."));
        v("go", go,
          says("State that starts with the go signal; the first state in 'during' if omitted."));
        v("step", step, says("State that starts with a load step."));
        v("onset_speed", onset_speed,
          Field::of(Quantity::speed)
              .within(1e-3, 10)
              .says("Speed that defines movement onset; onset_share is used if omitted."));
        v("onset_share", onset_share,
          Field::number()
              .within(0.001, 0.9)
              .says("Share of peak speed that defines movement onset."));
        v("end_still", end_still,
          Field::of(Quantity::time)
              .within(0, 10)
              .says("Time below the onset speed after which the movement has ended."));
        v("direction_after", direction_after,
          Field::of(Quantity::time)
              .within(1e-3, 10)
              .says("Time from onset at which the initial direction is measured."));
        v("deviation_after", deviation_after,
          Field::of(Quantity::time)
              .within(1e-3, 10)
              .says("Time from onset at which the early lateral deviation is measured."));
        v("continues", continues,
          says("Whether a movement that began before its states is analysed from their first tick "
               "on, e.g. one through a via point."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Axis from whose tip the line is viewed, which defines its left side; the axis "
                    "of 'reach' if omitted."));
        v("ideal", ideal,
          says("Perturbation with whose field the channel force is compared; the first with a "
               "viscous or curl field if omitted."));
        v("error", error,
          says("Value of a listed measure to which adaptation is fitted, by condition."));
    }
};
/// The states in which a custom measure is taken, one bit each.
uint64_t states_of(const CustomMeasure& measure);
inline constexpr const char* kHand = "hand";

/// A trial's movement, as frozen in trial-list.csv.
struct MovementPlan {
    Vec3 from_W = Vec3::Zero();
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();
    int channel = 0;  ///< 1: confined by a channel
    /// States in which that channel acts, one bit each; not in trial-list.csv.
    uint64_t channel_states = ~uint64_t{0};
    double field_share = 0;     ///< ratio of the trial's field to the ideal one; NaN in a channel
    Mat3 ideal = Mat3::Zero();  ///< matrix from velocity to the force of the ideal field [N*s/m]

    /// Unit vectors along the line, and across it to the left as seen from the tip of the axis; NaN
    /// if undefined.
    Vec3 along_W() const { return (to_W - from_W).normalized(); }
    Vec3 left_W() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        rows::visit_vector(v, "movement_from", f.from_W, "mm",
                           "start of the movement's straight line");
        rows::visit_vector(v, "movement_to", f.to_W, "mm", "end of that line");
        rows::visit_vector(v, "movement_axis", f.axis_W, "1",
                           "axis from whose tip the line is viewed, which defines its left side");
        v("movement_channel", f.channel, "1", "1: confined by a channel");
        v("movement_field_share", f.field_share, "1",
          "ratio of the trial's field to the ideal one; empty in a channel");
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                v(std::string("movement_ideal_") + "xyz"[row] + "xyz"[column], f.ideal(row, column),
                  "N*s/m", "matrix from velocity to the force of the ideal field");
        }
    }
};

struct Task;
/// The task's movement, with defaults filled in. `first_finger`: default for `of`.
Movement movement_of(const Task& task, const std::string& first_finger);

/// Checks the names of a task's measures, and that the task meets their requirements.
void check_measures(const TaskPlan& plan, const scene::Scene& scene, Diagnostics& diagnostics);

/// The movements by trial; none if the task's measures need no movement.
std::vector<MovementPlan> movements_of(const TaskPlan& plan, const scene::Scene& scene);
/// Adds columns for the numbers of the trials' movements to a list with one row per trial.
void add_movements(Table& list, const TaskPlan& plan, const scene::Scene& scene);
/// Name of the first column on movements; columns on reaches precede it.
inline constexpr const char* kFirstMovementColumn = "movement_from_x_mm";
/// Reads the movements by trial; none if the task's measures need no movement.
std::vector<MovementPlan> read_movements(const std::string& file);

}  // namespace dihaptic::task
