// Published measures, listed by name: the values that `measures` can have in a task, the
// requirements of each measure, and the movement that measures analyse. src/analysis/measures
// computes the measures; docs/measures-of-behaviour.md gives the equations.
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

/// A column of trials.csv. Units are written as in base/figure.h.
struct MeasureColumn {
    const char* name = nullptr;
    const char* unit = "";
    const char* what = "";
    /// Bounds of the column's plausible range, in the column's unit. A value outside the range is
    /// left out: it must be due to the recording or to the rule of the measure, not to the person.
    double least = 0;
    double most = 0;
};

struct MeasureRow {
    /// Requirements of a measure: a movement; a channel; a field with an ideal force; an object and
    /// two fingers; a state that starts with a load step; or, for `begun`, a movement that need not
    /// have ended.
    enum Needs : unsigned { movement = 1, channel = 2, ideal = 4, grip = 8, step = 16, begun = 32 };
    const char* name;
    unsigned needs;
    const char* source;
    /// Columns of the measure; unused elements at the end are empty.
    std::array<MeasureColumn, 5> columns;
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

/// Returns the row with this name, or null if there is none.
const MeasureRow* measure_row(const std::string& name);
/// Returns the columns that a measure has in files.
std::vector<Table::Column> columns_of_measure(const MeasureRow& row);
/// Returns the name that the column called `error` (without its unit) has in files, or "" if none
/// of the measures has this column.
std::string error_column(const std::vector<std::string>& measures, const std::string& error);
/// Returns the columns of all measures, and kNotMeasured.
std::vector<Table::Column> measure_columns();
/// Name of the column that lists the measures missing from a trial, with reasons.
inline constexpr const char* kNotMeasured = "not_measured";
Table::Column not_measured_column();

/// Statistic of a measure's values over the ticks of an attempt.
enum class Take { first, last, min, max, mean, median, sd, rms };
constexpr auto enum_names(Take) {
    return std::array{"first", "last", "min", "max", "mean", "median", "sd", "rms"};
}

struct State;

/// A custom measure of a task.
struct CustomMeasure {
    std::string name;  ///< name of the measure's column in trials.csv, with the unit
    std::string of;    ///< expression that is evaluated in each tick
    std::string when;  ///< condition that selects ticks; if empty, all ticks are used
    Take take = Take::max;
    /// Length of a moving mean, applied before the statistic is computed [s].
    std::optional<double> window;
    RefList<State> during;  ///< if empty, all states
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
    std::string of;                   ///< finger, body, or `hand` for the middle of all handles
    std::string from;                 ///< region at the start of the movement
    std::string to;                   ///< region at the end of the movement
    std::vector<std::string> during;  ///< states in which the movement takes place
    std::string go;    ///< state that starts with the go signal; if empty, the first of `during`
    std::string step;  ///< state that starts with a load step
    /// Speed that defines movement onset: an absolute speed or, if this is unset, a share of the
    /// peak speed.
    std::optional<double> onset_speed;  ///< [m/s]
    double onset_share = 0.05;
    /// Time for which the speed must stay below that of onset to end the movement [s].
    double end_still = 0;
    /// Time from onset to the measurement of the initial direction [s].
    double direction_after = 0.1;
    /// Time from onset to the measurement of the early lateral deviation [s].
    double deviation_after = 0.15;
    bool continues = false;    ///< whether movements can begin before the states `during`
    std::optional<Vec3> axis;  ///< like ReachMeasure::axis
    /// Perturbation whose field defines the ideal force; if empty, the first one.
    std::string ideal;
    /// Column of a listed measure, named without its unit. The column contains the error to which
    /// adaptation is fitted, i.e. how much of a perturbation has not been learned yet.
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
/// Returns the states in which a custom measure is taken, one bit for each state.
uint64_t states_of(const CustomMeasure& measure);
inline constexpr const char* kHand = "hand";

/// The movement of a trial, as frozen in trial-list.csv.
struct MovementPlan {
    Vec3 from_W = Vec3::Zero();
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();
    int channel = 0;  ///< 1 if the movement is confined by a channel, otherwise 0
    /// States in which the channel acts, one bit for each state. Not stored in trial-list.csv.
    uint64_t channel_states = ~uint64_t{0};
    double field_share = 0;  ///< ratio of the trial's field to the ideal field; NaN in a channel
    /// Matrix that maps velocity to the force of the ideal field [N*s/m].
    Mat3 ideal = Mat3::Zero();
    /// Age of the velocity from which the ideal field is computed [s]. Not stored in
    /// trial-list.csv.
    double ideal_delay = 0;

    /// Unit vectors: along_W() points along the line, and left_W() points across the line, to its
    /// left as seen from the tip of the axis. NaN if undefined.
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
/// Returns the task's movement, with defaults filled in. `first_finger` is the default for `of`.
Movement movement_of(const Task& task, const std::string& first_finger);

/// Checks the names of a task's measures, and checks that the task meets the requirements of these
/// measures.
void check_measures(const TaskPlan& plan, const scene::Scene& scene, Diagnostics& diagnostics);

/// Returns the movement of each trial, or an empty list if the task's measures need no movement.
std::vector<MovementPlan> movements_of(const TaskPlan& plan, const scene::Scene& scene);
/// Appends columns with the numbers of each trial's movement to a list that has one row per trial.
void add_movements(Table& list, const TaskPlan& plan, const scene::Scene& scene);
/// Name of the first column that describes movements; columns that describe reaches precede it.
inline constexpr const char* kFirstMovementColumn = "movement_from_x_mm";
/// Reads the movement of each trial. Returns an empty list if the task's measures need no movement.
std::vector<MovementPlan> read_movements(const std::string& file);

}  // namespace dihaptic::task
