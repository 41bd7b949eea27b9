// The task in an experiment file (docs/files.md): a small state machine that runs in each trial,
// its perturbations, and the order of the trials.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string>

#include "hand/spec.h"
#include "rows/trial_kind.h"
#include "task/effects/perturbation.h"
#include "task/file/corrections.h"
#include "task/file/draws.h"
#include "task/file/drive.h"
#include "task/file/form.h"
#include "task/file/motor.h"
#include "task/file/procedure_spec.h"
#include "task/file/show.h"
#include "task/file/sound.h"
#include "task/plan/measures.h"

namespace dihaptic::task {

/// Condition that ends a state.
enum class When {
    inside,      ///< a finger's handle, a hand or a body is in a region
    outside,     ///< a finger's handle, a hand or a body is outside a region
    touched,     ///< a finger presses a body
    released,    ///< no finger presses a body
    gripped,     ///< two fingers press a body
    lifted,      ///< a body is at least a given height above its initial position
    still,       ///< the finger, all fingers or a body move more slowly than a given speed
    key,         ///< the operator has pressed a key
    button,      ///< a button on a finger's device is held down
    trigger,     ///< a code has arrived through one of the rig's outlets
    answered,    ///< the number that the state asks for has been entered
    time,        ///< a given time has passed since the state was entered
    expression,  ///< the expression in the text is true (expression.h)
};

/// Properties of conditions: one row for each When, in the same order.
struct WhenRow {
    /// Fields of an Exit that a condition uses. any_finger: like `finger`, but the default is any
    /// finger, all fingers or their middle, rather than the first finger. comes: not a field, but
    /// marks a condition that does not depend on the hand's motion.
    enum Has : unsigned {
        region = 1,
        body = 2,
        finger = 4,
        any_finger = 8,
        height = 16,
        speed = 32,
        key = 64,
        button = 128,
        code = 256,
        comes = 512,
        what = 1024,
        count = 2048,
        after = 4096
    };
    const char* name;
    unsigned has;  ///< fields used in addition to those of all conditions
};
constexpr WhenRow kWhenTable[] = {
    {"inside", WhenRow::region | WhenRow::any_finger | WhenRow::what | WhenRow::count},
    {"outside", WhenRow::region | WhenRow::any_finger | WhenRow::what | WhenRow::count},
    {"touched", WhenRow::body | WhenRow::any_finger | WhenRow::count},
    {"released", WhenRow::body | WhenRow::any_finger | WhenRow::count},
    {"gripped", WhenRow::body | WhenRow::any_finger | WhenRow::count},
    {"lifted", WhenRow::body | WhenRow::height | WhenRow::count},
    {"still", WhenRow::any_finger | WhenRow::what | WhenRow::speed | WhenRow::count},
    {"key", WhenRow::key | WhenRow::comes | WhenRow::count},
    {"button", WhenRow::button | WhenRow::finger | WhenRow::comes | WhenRow::count},
    {"trigger", WhenRow::code | WhenRow::comes | WhenRow::count},
    {"answered", WhenRow::comes},
    {"time", WhenRow::comes | WhenRow::after},
    {"", WhenRow::count},
};
static_assert(std::size(kWhenTable) == static_cast<size_t>(When::expression) + 1);
constexpr auto enum_names(When) {
    std::array<const char*, std::size(kWhenTable)> out{};
    std::transform(std::begin(kWhenTable), std::end(kWhenTable), out.begin(),
                   [](const WhenRow& row) { return row.name; });
    return out;
}

/// Returns a remedy for a key that only some conditions can have: those with any of the fields
/// `any` (WhenRow::Has). `given` is the condition in the file.
std::string conditions_with(const std::string& given, unsigned any);

struct State;

/// A transition out of a state: to another state, or to the end of the trial with an outcome.
struct Exit {
    When when = When::time;
    std::string condition;  ///< text of the expression if `when` is When::expression
    Ref<Region> region;     ///< region for inside and outside
    bool shown = false;     ///< whether inside and outside use the displayed position
    Ref<scene::Body> body;  ///< body for touched, released, gripped and lifted
    std::string what;       ///< body used in place of a finger, for inside, outside and still
    std::string finger;  ///< a finger or a hand; if empty, the first finger, except for touched and
                         ///< released (any finger), gripped (any two), still (all fingers), and
                         ///< inside and outside (the middle of all fingers)
    Formula height = 0.02;  ///< height for lifted [m]
    Formula speed = 0.02;   ///< speed for still [m/s]
    int count = 1;          ///< number of times that the condition must be met
    Formula hold = 0;       ///< time for which the condition must hold without interruption or, for
                            ///< When::time, the time in the state [s]
    std::string key;        ///< for key, one letter or digit
    int button = 0;         ///< for button, its number, counted from 0
    int code = 0;           ///< for trigger, the code; 0 for any code
    Ref<State> to;
    std::string outcome;  ///< outcome with which the trial ends
    int chooses = 0;      ///< interval, 1 or 2, that is chosen by the answer that ends the trial
    bool redo = false;    ///< whether the trial will be repeated
    bool ends_session = false;  ///< whether the remaining trials are left out
    /// Message shown for at least Task::feedback, then until the next message.
    std::string feedback;
    Ref<SoundSpec> sound;  ///< sound that starts when this exit is taken
    std::string hed;       ///< HED tags that describe the outcome
    Place place;

    /// Whether the condition uses any of these fields (WhenRow::Has).
    bool has(unsigned any) const { return (kWhenTable[static_cast<size_t>(when)].has & any) != 0; }
    /// The condition as written in the file: a word of kWhenTable, or an expression.
    std::string given() const {
        return when == When::expression ? condition : std::string(enum_name(when));
    }
    void set_given(const std::string& text) {
        when = When::expression;
        condition = text;
        for (size_t i = 0; i < static_cast<size_t>(When::expression); ++i) {
            if (text == kWhenTable[i].name) when = static_cast<When>(i);
        }
    }

    template <class Visitor>
    void visit(Visitor& v) {
        std::string text = given();
        v("when", text,
          Field::text().required().says(
              "Condition that ends the state: one of the words, or an expression."));
        set_given(text);
        const auto of = [&](unsigned any, const char* name, auto& value, Field field = {}) {
            if (has(any)) {
                v(name, value, field);
            } else if constexpr (requires { v.foreign(name, field, std::string()); }) {
                v.foreign(name, field, conditions_with(text, any));
            }
        };
        of(WhenRow::region, "region", region,
           says("Region of the condition 'inside' or 'outside'."));
        of(WhenRow::region, "shown", shown,
           says("Whether the hand's displayed position is used instead of its true position."));
        of(WhenRow::body, "body", body,
           says("Body of the condition 'touched', 'released', 'gripped' or 'lifted'."));
        of(WhenRow::what, "what", what,
           says("Body, finger or hand whose position or speed is tested, in place of 'finger'."));
        of(WhenRow::finger | WhenRow::any_finger, "finger", finger,
           says("Finger or hand of the condition; if omitted, any finger, all fingers or their "
                "middle, depending on the condition; for a button, the scene's first finger."));
        of(WhenRow::height, "height", height,
           Field::length().within(1e-4, 10).says(
               "Height of the body above its position at the beginning of the trial."));
        of(WhenRow::speed, "speed", speed,
           Field::of(Quantity::speed)
               .positive()
               .at_most(100)
               .says("Speed below which the condition 'still' is met."));
        of(WhenRow::count, "count", count,
           Field::number().within(1, 10000).says(
               "Number of times that the condition has to be met in the state."));
        constexpr Field kTime = Field::of(Quantity::time).within(0, 3600);
        of(WhenRow::after, "after", hold, kTime.formerly("hold").says("Duration of the state."));
        if (!has(WhenRow::after))
            v("hold", hold,
              kTime.says("Time for which the condition has to hold without interruption."));
        of(WhenRow::key, "key", key, says("Letter or digit of the operator's key."));
        of(WhenRow::button, "button", button,
           Field::number().within(0, 31).says("Button of the finger's device, counted from 0."));
        of(WhenRow::code, "code", code,
           Field::number().within(0, 255).says(
               "Code that arrives through one of the rig's outlets; 0: any code."));
        v("to", to, says("Next state."));
        v("outcome", outcome, says("Outcome with which the exit ends the trial."));
        v("chooses", chooses,
          Field::number().within(0, 2).says(
              "Which of two intervals the participant chooses by this exit."));
        v("redo", redo, says("Whether the trial is to be repeated."));
        v("ends_session", ends_session,
          says("Whether the session ends with this trial, and its other trials are left out."));
        v("feedback", feedback,
          says("Text that is shown on this exit, for at least feedback_s; names in braces are "
               "replaced with numbers."));
        v("sound", sound, says("Sound that is played once on this exit."));
        v("hed", hed, says("HED tags of the outcome, for the export to BIDS."));
    }
};

/// A step of the simulated hand in a state: a step as in a script, or a reach to a region.
struct HandStep {
    Formula duration = 0;             ///< [s]
    Ref<Region> reach;                ///< region to which the hand's centre moves
    FormulaVec3 move{};               ///< displacement of the hand's centre [m]
    std::optional<Formula> aperture;  ///< aperture at the end of the step [m]
    RefList<scene::Finger> fingers;   ///< fingers that move; if empty, all fingers
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("duration", duration,
          Field::of(Quantity::time)
              .positive()
              .at_most(3600)
              .required()
              .says("Duration of the step."));
        v("reach", reach, says("Region to which the middle of the hand moves."));
        v("move", move,
          Field::length()
              .within(-hand::kFarthest, hand::kFarthest)
              .says("Displacement of the middle of the hand, relative to the region if there is "
                    "one."));
        v("aperture", aperture,
          Field::length()
              .within(0, hand::kFarthest)
              .says("Distance between the fingers at the end of the step."));
        v("fingers", fingers, says("Fingers that move; all if omitted."));
    }
};

/// Placement of a body when a state begins.
struct StatePlace {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> position;  ///< if unset, the body stays at its current position [m]
    /// Initial velocity [m/s]; if unset, a body that is placed starts at rest.
    std::optional<FormulaVec3> velocity;
    bool held = false;     ///< whether the body is kept in place while the state lasts
    bool removed = false;  ///< whether the body is out of reach and invisible while the state lasts
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body,
          Field::text().required().says("Body that is placed when the state begins."));
        v("position", position,
          Field::length().within(-100, 100).says(
              "New position of the body's origin; unchanged if omitted."));
        v("velocity", velocity,
          Field::of(Quantity::speed)
              .within(-100, 100)
              .says("Velocity with which the body is released there; at rest if omitted."));
        v("held", held, says("Whether the body is kept there while the state lasts."));
        v("removed", removed,
          says("Whether the body is out of reach and invisible while the state lasts."));
    }
};

struct State {
    std::string name;
    Show show;
    std::vector<LookSpec> look;
    bool perturbed = true;  ///< whether the trial's perturbations can act in the state
    int interval = 0;       ///< interval to which the state belongs, 1 or 2; 0 for none
    std::string message;
    std::vector<std::string> lines;  ///< texts shown below the message while the state lasts
    bool countdown = false;        ///< whether a line shows the seconds left until the exit by time
    std::optional<AskSpec> ask;    ///< rating that the participant is asked for
    std::optional<FormSpec> form;  ///< form with several questions, in place of `ask`
    int marker = 0;                ///< event code sent on entry into the state; 0 for none
    bool patch = false;      ///< whether the rig's photodiode patch is white while the state lasts
    Refs<SoundSpec> sounds;  ///< sounds that start or continue while the state lasts
    std::vector<StatePlace> places;
    std::vector<DriveSpec> drives;
    std::vector<MotorSpec> motors;
    std::vector<Exit> exits;  ///< exits of the state; the first one whose condition is met is taken
    std::vector<HandStep> hand;  ///< steps of the simulated hand, starting at entry into the state
    std::string hed;             ///< HED tags for the beginning of the state
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the state, to which exits refer."));
        show.visit_in(v);
        v("look", look, says("Colours and sizes of objects while the state lasts."));
        v("perturbed", perturbed, says("Whether the trial's perturbations can act in the state."));
        v("interval", interval,
          Field::number().within(0, 2).says(
              "Interval of a two-interval trial to which the state belongs; 0: none."));
        v("message", message,
          says("Text that is shown from the state's beginning until the next message; names in "
               "braces are replaced with numbers."));
        v("lines", lines, says("Texts below the message while the state lasts, at most two."));
        v("countdown", countdown,
          says("Whether a line shows the seconds left until the state's exit by time."));
        v("ask", ask, says("Rating that the participant is asked for while the state lasts."));
        v("form", form,
          says("Form that the participant fills in while the state lasts, in place of 'ask'."));
        v("marker", marker,
          Field::number().within(0, 255).says(
              "Event code that is sent when the state begins; 0: none."));
        v("patch", patch,
          says("Whether the rig's photodiode patch is white, not black, while the state lasts."));
        v("sounds", sounds,
          says("Sounds that start with the state; those with 'lasts: state' end with it, unless "
               "the next state lists them too."));
        v("place", places, says("Bodies that are placed when the state begins."));
        v("drive", drives, says("Bodies that move on paths while the state lasts."));
        v("motors", motors, says("Joints that motors move or push while the state lasts."));
        v("exits", exits, says("Exits of the state; the first whose condition is met is taken."));
        v("simulated_hand", hand,
          Field{}.formerly("hand").says(
              "Steps that a simulated hand or person performs in the state."));
        v("hed", hed, says("HED tags of the state's beginning, for the export to BIDS."));
    }

    /// The questions that the state asks: its rating, or the items of its form.
    std::span<const AskSpec> questions() const {
        if (form) return form->items;
        return ask ? std::span(&*ask, 1) : std::span<const AskSpec>();
    }
};

/// Initial placement of a body in a trial, in place of its position in the scene. The placement is
/// given as a position, or as the coordinate of a joint whose second body is the one to be placed.
/// Bodies attached to that body move with it.
struct BodyPlace {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> position;  ///< [m]
    Ref<scene::Joint> joint;
    std::optional<Formula> angle;         ///< [rad]
    std::optional<Formula> displacement;  ///< [m]
    std::optional<FormulaVec3> velocity;  ///< initial velocity of the body [m/s]
    Formula rate = 0;                     ///< initial rate of a hinge [rad/s]
    Formula speed = 0;                    ///< initial speed of a slider [m/s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body,
          Field::text().says(
              "Body whose position at the beginning of the trial differs from that in the scene."));
        v("position", position,
          Field::length().within(-100, 100).says("Initial position of the body's origin."));
        v("joint", joint,
          Field::text().says("Joint, in place of a body, whose initial coordinate is not 0; all "
                             "bodies attached to its second body move with it."));
        v("angle", angle,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Initial angle of the joint, which must be a hinge."));
        v("displacement", displacement,
          Field::length().within(-100, 100).says(
              "Initial displacement of the joint, which must be a slider."));
        v("velocity", velocity,
          Field::of(Quantity::speed).within(-100, 100).says("Initial velocity of the body."));
        v("rate", rate,
          Field::of(Quantity::angular_speed)
              .within(-1000, 1000)
              .says("Initial angular velocity of the joint, which must be a hinge."));
        v("speed", speed,
          Field::of(Quantity::speed)
              .within(-100, 100)
              .says("Initial velocity of the joint, which must be a slider."));
    }
};

/// A factor whose levels are crossed with those of other factors to generate conditions.
struct Factor {
    std::string factor;               ///< name of the factor, which gives the unit of its levels
    std::vector<std::string> levels;  ///< numbers or texts
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("factor", factor,
          Field::text().required().says(
              "Name of the factor, which may end in the unit of its levels."));
        v("levels", levels,
          Field::text().required().says("Levels of the factor, either all numbers or all texts."));
    }
};

/// A condition of trials: regions and perturbations that replace those with the same name, initial
/// placements of bodies, and looks.
struct Condition {
    std::string name;
    Node factors;             ///< level of each factor
    Ref<scene::Body> object;  ///< body whose lifts are measured; if empty, the scene's object
    std::vector<BodyPlace> places;
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    std::vector<LookSpec> look;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the condition; with 'cross', of the generated "
                                        "condition that this one extends."));
        v("factors", factors,
          says(
              "A level of each factor, by the factor's name; generated automatically by 'cross'."));
        v("object", object, says("Body whose lifts are measured; the scene's object if omitted."));
        v("places", places, says("Initial placements of bodies in place of those in the scene."));
        v("regions", regions, says("Regions that replace those of the same name."));
        v("perturbations", perturbations,
          says("Perturbations that replace those of the same name."));
        v("look", look, says("Colours and sizes in these trials."));
    }
};

enum class Order { sequential, shuffled, latin_square, counterbalanced };
constexpr auto enum_names(Order) {
    return std::array{"sequential", "shuffled", "latin_square", "counterbalanced"};
}

using rows::TrialKind;

/// Trials of another kind that are inserted at random points in a block.
struct Insert {
    TrialKind kind = TrialKind::catch_trial;
    int count = 1;
    int gap = 1;  ///< minimum number of other trials between two inserted trials
    Refs<PerturbationSpec> perturb;
    RefList<Condition> conditions;  ///< conditions of the inserted trials; if empty, the condition
                                    ///< of the previous trial
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, says("Kind of the inserted trials, for the analysis."));
        v("conditions", conditions,
          says("Conditions of these trials, in turn; if omitted, each takes the condition of the "
               "preceding trial."));
        v("count", count,
          Field::number().within(1, 10000).required().says("Number of inserted trials."));
        v("gap", gap,
          Field::number().within(1, 10000).says(
              "Smallest number of other trials between two inserted ones."));
        v("perturb", perturb, says("Perturbations of these trials; none if omitted."));
    }
};

/// Whether a block is run in each round or only once, i.e. before the first round or after the
/// last.
enum class Once { no, before, after };
constexpr auto enum_names(Once) {
    return std::array{"no", "before", "after"};
}

struct Block {
    std::string name;
    TrialKind kind = TrialKind::baseline;
    RefList<Condition> conditions;  ///< if empty, all conditions
    Once once = Once::no;
    int repeats = 1;  ///< number of times each condition is run
    /// Order of the conditions, which is generated anew for each repeat.
    Order order = Order::shuffled;
    Refs<PerturbationSpec> perturb;  ///< perturbations that act together
    int ramp = 0;  ///< number of trials over which the perturbations' share rises to 1; 0 for an
                   ///< abrupt start
    RefList<ProcedureSpec> procedures;  ///< if not empty, the block consists of the interleaved
                                        ///< trials of these procedures
    std::vector<Insert> insert;
    std::string until;  ///< condition on variables that ends the block; empty if there is none
    double rest = 0;  ///< duration of the break before the block, unless it is the first block [s]
    std::vector<PageSpec> pages;  ///< pages shown before the block begins
    Ref<State> begins;  ///< state in which the block's trials begin; if empty, the first state
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the block."));
        v("kind", kind, says("Kind of the block's trials, for the analysis."));
        v("conditions", conditions, says("Conditions of the block; all if omitted."));
        v("once", once,
          says("Whether the block is run only once, outside the rounds: before the first round or "
               "after the last."));
        v("begins", begins,
          Field::text().says("State in which the block's trials begin; the first one if omitted."));
        v("repeats", repeats,
          Field::number().within(1, 10000).says("Number of times that each condition is run."));
        v("order", order, says("Order of the conditions, generated for each repeat."));
        v("perturb", perturb,
          says("Perturbations that act together in the block's trials, at most eight; none if "
               "omitted."));
        v("ramp", ramp,
          Field::number().within(0, 100000).says(
              "Number of trials in which the perturbations' share rises to 1; 0: at once."));
        v("procedures", procedures,
          says("Procedures whose interleaved trials make up the block, in place of 'conditions' "
               "and 'repeats'."));
        v("insert", insert,
          says("Additional trials of other kinds, inserted at random but never first."));
        v("until", until,
          says("Condition on variables that ends the block; its remaining trials are skipped."));
        v("rest", rest,
          Field::of(Quantity::time)
              .within(0, 3600)
              .says("Break before the block, unless it is the session's first."));
        v("pages", pages,
          says("Pages shown one after another in place of the scene before the block."));
    }
};

/// Whether and when a failed trial will be repeated.
enum class Redo { never, next, end_of_block, random };
constexpr auto enum_names(Redo) {
    return std::array{"never", "next", "end_of_block", "random"};
}

/// Measure of a reach, taken once in each trial, during one of its states.
///
/// angle    right-handed angle about `axis` from the direction of `to` to that of the handle when
///          the handle is at `distance` from `from`; both directions are seen from `from`
/// extent   displacement of the handle along the line from `from` to `to` at the end of its first
///          stroke
enum class Measure { angle, extent };
constexpr auto enum_names(Measure) {
    return std::array{"angle", "extent"};
}

struct ReachMeasure {
    Measure measure = Measure::angle;
    Ref<scene::Finger> finger;  ///< if empty, the scene's first finger
    Ref<Region> from;
    Ref<Region> to;
    Refs<State> during;
    double distance = 0.05;    ///< [m]
    std::optional<Vec3> axis;  ///< if unset, the axis of the first perturbation that has one, or z
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("measure", measure,
          says("Quantity that is measured: the direction of the reach, or the extent of its first "
               "stroke."));
        v("finger", finger, says("Finger that reaches; the scene's first finger if omitted."));
        v("from", from, Field::text().required().says("Region in which the reach starts."));
        v("to", to, Field::text().required().says("Region in which the target of the reach lies."));
        v("during", during,
          Field::text().required().says(
              "State in which the reach is measured, or a list of such states."));
        v("distance", distance,
          Field::length().within(1e-4, 10).says(
              "Distance from the start at which the angle is measured."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Axis of the angles, right-handed; if omitted, the axis of the first "
                    "perturbation that has one, or z."));
    }
};

/// A group of fingers to which conditions can refer.
struct Hand {
    std::string name;
    RefList<scene::Finger> fingers;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the group, for use in conditions."));
        v("fingers", fingers, Field::text().required().says("Fingers of the group."));
    }
};

/// A number that rules can change between trials.
struct Variable {
    std::string name;
    double start = 0;  ///< initial value, in the unit at the end of the variable's name
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the variable, which may end in its unit."));
        v("start", start,
          Field::number().within(-1e9, 1e9).says(
              "Value at the session's start, in the unit of its name."));
    }
};

/// A rule that updates a variable at the end of a trial.
struct Rule {
    std::string when;  ///< condition under which the rule applies; if empty, it always applies
    Ref<Variable> set;
    std::string to;  ///< expression for the new value
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("when", when, says("Condition on the ended trial; if omitted, the rule always applies."));
        v("set", set, Field::text().required().says("Variable that is set."));
        v("to", to, Field::text().required().says("Expression for the new value."));
    }
};

struct Task {
    std::vector<Hand> hands;
    /// The hand of each of two participants; empty if there is one participant.
    RefList<Hand> participants;
    std::vector<DrawSpec> draws;
    std::vector<Variable> variables;
    /// Rules that update variables after each trial, applied in this order.
    std::vector<Rule> after_trial;
    std::vector<Factor> cross;  ///< factors whose combinations generate the conditions
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    std::vector<SoundSpec> sounds;
    std::vector<State> states;  ///< states of a trial, which starts in the first one
    /// If empty, there is a single condition without a name. If factors are crossed, these are
    /// additions to the generated conditions.
    std::vector<Condition> conditions;
    /// The blocks are run once in each round; if empty, they are run once.
    std::vector<Condition> rounds;
    Order round_order = Order::sequential;
    std::vector<ProcedureSpec> procedures;
    Refs<scene::Body> stays;  ///< bodies that stay where they are between trials
    std::vector<Block> blocks;
    Redo redo = Redo::end_of_block;
    int most_attempts = 3;  ///< maximum number of attempts at a trial
    /// Time for which feedback is shown, during which no message replaces it and no trial starts
    /// [s].
    double feedback = 1;
    /// Whether feedback appears below the message instead of replacing it.
    bool feedback_beside = false;
    std::vector<std::string> lines;  ///< texts shown below the message throughout the session
    std::optional<ReachMeasure> reach;
    std::vector<std::string> measures;  ///< names from kMeasureTable
    std::vector<CustomMeasure> custom_measures;
    std::optional<Movement> movement;  ///< movement analysed by `measures`
    std::optional<CorrectionSpec> corrections;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("hands", hands, says("Groups of fingers for use in conditions."));
        v("participants", participants,
          says("Hands of two participants, one each, who do the task together; one participant has "
               "all hands if omitted."));
        v("draws", draws, says("Numbers and texts that are drawn for each trial."));
        v("variables", variables, says("Numbers that rules change between trials."));
        v("after_trial", after_trial,
          says("Rules that set variables when a trial ends, applied in this order."));
        v("cross", cross, says("Factors whose crossed levels make the conditions."));
        v("regions", regions,
          says("Named spheres, at most 16, which serve as locations for hands and can be shown."));
        v("perturbations", perturbations,
          says("Named changes of visual feedback, properties and loads, for use in blocks and "
               "inserts."));
        v("sounds", sounds, says("Sounds, at most 32, for use in states and exits."));
        v("states", states,
          Field::text().required().says("States of each trial, which starts in the first one."));
        v("conditions", conditions,
          says("Conditions of trials; if omitted, there is one condition without a name."));
        v("rounds", rounds, says("Conditions of rounds: the blocks are run once in each round."));
        v("round_order", round_order, says("Order of the rounds."));
        v("procedures", procedures,
          says("Procedures that choose the share of a perturbation, or a number, from the answers "
               "so far."));
        v("stays", stays,
          says("Bodies that are not put back between trials: each trial begins with them where the "
               "previous trial left them."));
        v("blocks", blocks, Field::text().required().says("Blocks of trials, in order."));
        v("redo", redo, says("Whether and when a failed trial is repeated."));
        v("most_attempts", most_attempts,
          Field::number().within(1, 100).says("Largest number of attempts at one trial."));
        v("feedback", feedback,
          Field::of(Quantity::time)
              .within(0, 60)
              .says("Time for which feedback is shown before the next message or trial."));
        v("feedback_beside", feedback_beside,
          says("Whether feedback is a line below the message for that time and does not delay "
               "messages."));
        v("lines", lines, says("Texts below the message throughout the session, at most two."));
        v("reach", reach, says("Measure of a reach, taken once in each trial."));
        v("measures", measures,
          says("Names of the [measures of behaviour](measures-of-behaviour.md) that "
               "are reported for each attempt."));
        v("custom_measures", custom_measures,
          Field{}
              .formerly("own_measures")
              .says("Custom measures, given as expressions and reported for each attempt."));
        v("movement", movement,
          says("Movement that the measures analyse; keys omitted here are copied from 'reach'."));
        v("corrections", corrections,
          says("Trials in which something happens that the hand corrects, to measure the latency "
               "of the correction."));
    }
};

}  // namespace dihaptic::task
