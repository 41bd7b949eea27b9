// The task of an experiment file (docs/files.md): a small state machine that each trial runs
// through, what perturbs it, and the trials' order.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include "hand/spec.h"
#include "rows/trial_kind.h"
#include "task/effects/perturbation.h"
#include "task/file/draws.h"
#include "task/file/drive.h"
#include "task/file/motor.h"
#include "task/file/procedure_spec.h"
#include "task/file/rating.h"
#include "task/file/show.h"
#include "task/file/sound.h"
#include "task/plan/measures.h"

namespace dihaptic::task {

/// What ends a state.
enum class When {
    inside,      ///< a finger's handle, a hand or a body is in a region
    outside,     ///< it is not
    touched,     ///< a finger presses a body
    released,    ///< no finger presses a body
    gripped,     ///< two fingers press a body
    lifted,      ///< a body is above its place by a height
    still,       ///< the finger, or all fingers, or a body, are slower than a speed
    key,         ///< the operator pressed a key
    button,      ///< a button of a finger's device is held
    trigger,     ///< a code came in from outside, on one of the rig's outlets
    answered,    ///< the number that the state asks for was typed
    time,        ///< the state's time is over
    expression,  ///< what the text says (expression.h)
};

/// What is known of a condition: a row for each When, in its order.
struct WhenRow {
    /// Fields of an Exit. any_finger: a finger that, left out, is any, all or their middle, and not
    /// the first. comes: no field; the condition comes whatever the hand does.
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
    unsigned has;  ///< besides the fields of all
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

/// A remedy for a key that only these conditions have (WhenRow::Has), where `given` is another.
std::string conditions_with(const std::string& given, unsigned any);

struct State;

/// One way out of a state: to another, or out of the trial with an outcome.
struct Exit {
    When when = When::time;
    std::string condition;  ///< text of an expression
    Ref<Region> region;     ///< inside, outside
    bool shown = false;     ///< inside, outside: judged by where the finger is displayed
    Ref<scene::Body> body;  ///< touched, released, gripped, lifted
    std::string what;       ///< inside, outside, still: a body, in place of a finger
    std::string finger;     ///< a finger or a hand; if empty, the first finger; touched, released:
                            ///< any finger; gripped: any two; still: all fingers; inside, outside:
                            ///< the middle of all
    Formula height = 0.02;  ///< lifted [m]
    Formula speed = 0.02;   ///< still [m/s]
    int count = 1;          ///< the exit is taken when the condition is met for this time
    Formula hold = 0;       ///< time for which the condition must hold without a break to be met;
                            ///< with When::time, the time in the state [s]
    std::string key;        ///< one letter or digit
    int button = 0;         ///< counted from 0
    int code = 0;           ///< trigger; 0: any
    Ref<State> to;
    std::string outcome;   ///< ends the trial with this outcome
    int chooses = 0;       ///< ends the trial with the answer that this interval has more
    bool redo = false;     ///< the trial is to be done again
    std::string feedback;  ///< shown for Task::feedback at least, then until the next message
    Ref<SoundSpec> sound;  ///< begins when the exit is taken
    Place place;

    /// Whether its condition has any of these (WhenRow::Has).
    bool has(unsigned any) const { return (kWhenTable[static_cast<size_t>(when)].has & any) != 0; }
    /// Its condition as the file has it: a word of the table, or an expression.
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
              "What ends the state: one of the conditions' words, or an expression."));
        set_given(text);
        const auto of = [&](unsigned any, const char* name, auto& value, Field field = {}) {
            if (has(any)) {
                v(name, value, field);
            } else if constexpr (requires { v.foreign(name, field, std::string()); }) {
                v.foreign(name, field, conditions_with(text, any));
            }
        };
        of(WhenRow::region, "region", region, says("Region that the thing is to be in, or not."));
        of(WhenRow::region, "shown", shown,
           says("Whether the hand counts where it is displayed, in place of where it is."));
        of(WhenRow::body, "body", body, says("Body that is touched, released, gripped or lifted."));
        of(WhenRow::what, "what", what,
           says("Body, finger or hand that the condition is about, in place of a finger."));
        of(WhenRow::finger | WhenRow::any_finger, "finger", finger,
           says("Finger or hand that the condition is about; left out, it is any of "
                "them, all or their middle, and of a button the scene's first."));
        of(WhenRow::height, "height", height,
           Field::length().within(1e-4, 10).says(
               "How far the body has to be above where it begins the trial."));
        of(WhenRow::speed, "speed", speed,
           Field::of(Quantity::speed)
               .positive()
               .at_most(100)
               .says("Speed below which a thing is still."));
        of(WhenRow::count, "count", count,
           Field::number().within(1, 10000).says(
               "How often the condition has to be met in the state."));
        constexpr Field kTime = Field::of(Quantity::time).within(0, 3600);
        of(WhenRow::after, "after", hold, kTime.formerly("hold").says("How long the state lasts."));
        if (!has(WhenRow::after))
            v("hold", hold, kTime.says("How long the condition has to hold without a break."));
        of(WhenRow::key, "key", key, says("Letter or digit that the operator presses."));
        of(WhenRow::button, "button", button,
           Field::number().within(0, 31).says("Button of the finger's device, counted from 0."));
        of(WhenRow::code, "code", code,
           Field::number().within(0, 255).says(
               "Code that comes in on one of the rig's outlets; 0 is any."));
        v("to", to, says("State that follows."));
        v("outcome", outcome, says("Ends the trial, with this outcome."));
        v("chooses", chooses,
          Field::number().within(0, 2).says(
              "Interval that the exit says the participant chose, of two alternatives."));
        v("redo", redo, says("Whether the trial is to be done again."));
        v("feedback", feedback,
          says("Text that is shown then, for feedback_s at least; numbers stand in braces."));
        v("sound", sound, says("Sound that is played then, once."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A step of the simulated hand in a state: as in a script, or to a region.
struct HandStep {
    double duration = 0;             ///< [s]
    Ref<Region> reach;               ///< that the hand's centre goes to
    Vec3 move = Vec3::Zero();        ///< displacement of the hand's centre [m]
    std::optional<double> aperture;  ///< aperture at the end [m]
    RefList<scene::Finger> fingers;  ///< only these move; empty: all
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("duration", duration,
          Field::of(Quantity::time)
              .positive()
              .at_most(3600)
              .required()
              .says("How long the step lasts."));
        v("reach", reach, says("Region that the middle of the hand goes to."));
        v("move", move,
          Field::length()
              .within(-hand::kFarthest, hand::kFarthest)
              .says("How far the middle of the hand goes, from that region if one is named."));
        v("aperture", aperture,
          Field::length()
              .within(0, hand::kFarthest)
              .says("Distance between the fingers at the step's end."));
        v("fingers", fingers, says("Fingers that move; left out: all."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Where a state puts a body as it begins.
struct StatePlace {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> position;  ///< unset: where it is [m]
    std::optional<FormulaVec3> velocity;  ///< unset: at rest, if it is put anywhere [m/s]
    bool held = false;                    ///< it is held still there while the state lasts
    bool removed = false;                 ///< it is out of reach and sight while the state lasts
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body,
          Field::text().required().says("Body that is put somewhere as the state begins."));
        v("position", position,
          Field::length().within(-100, 100).says(
              "Where its origin is put; left out, it stays where it is."));
        v("velocity", velocity,
          Field::of(Quantity::speed)
              .within(-100, 100)
              .says("Velocity with which it is thrown from there; left out, it is at rest."));
        v("held", held, says("Whether the body is kept there while the state lasts."));
        v("removed", removed,
          says("Whether the body is out of reach and sight while the state lasts."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct State {
    std::string name;
    Show show;
    std::vector<LookSpec> look;
    bool perturbed = true;  ///< the trial's perturbations act
    int interval = 0;       ///< of two, 1 or 2, that it belongs to; 0: none
    std::string message;
    std::vector<std::string> lines;  ///< texts below the message, while the state lasts
    bool countdown = false;          ///< a line says for how many seconds the state may last still
    std::optional<AskSpec> ask;      ///< a number that is asked for
    int marker = 0;                  ///< event code on entering; 0: none
    bool patch = false;              ///< the rig's patch is white while the state lasts
    Refs<SoundSpec> sounds;          ///< that begin with it, or go on while it lasts
    std::vector<StatePlace> places;
    std::vector<DriveSpec> drives;
    std::vector<MotorSpec> motors;
    std::vector<Exit> exits;     ///< the first whose condition holds is taken
    std::vector<HandStep> hand;  ///< steps of the simulated hand from entering the state on
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the state, by which exits lead to it."));
        show.visit_in(v);
        v("look", look, says("Colours and sizes while the state lasts."));
        v("perturbed", perturbed, says("Whether the trial's perturbations may act."));
        v("interval", interval,
          Field::number().within(0, 2).says(
              "Interval of a two-interval trial that the state belongs to; 0 is none."));
        v("message", message,
          says("Text that is shown from the state's beginning until the next "
               "message; numbers stand in braces."));
        v("lines", lines, says("Texts below the message while the state lasts, two at most."));
        v("countdown", countdown,
          says("Whether a line says how many seconds are left of the state's exit by time."));
        v("ask", ask, says("A number that the participant is asked for while the state lasts."));
        v("marker", marker,
          Field::number().within(0, 255).says(
              "Event code that is sent as the state begins; 0 is none."));
        v("patch", patch,
          says("Whether the rig's patch for a photodiode is white while the state lasts; otherwise "
               "it is black."));
        v("sounds", sounds,
          says("Sounds that begin with the state; those that last as long as a state end with it, "
               "unless the next one names them too."));
        v("place", places, says("Bodies that are put somewhere as the state begins."));
        v("drive", drives, says("Bodies that move on paths while the state lasts."));
        v("motors", motors, says("Joints that are moved or pushed while the state lasts."));
        v("exits", exits, says("Ways out of the state; the first whose condition is met counts."));
        v("simulated_hand", hand,
          Field{}.formerly("hand").says(
              "Steps that the state asks of a simulated hand or person."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Where a body begins the trial, in place of its position in the scene: by its position, or by the
/// coordinate of a joint whose second body it is. What hangs on that body comes along.
struct BodyPlace {
    Ref<scene::Body> body;
    std::optional<FormulaVec3> position;  ///< [m]
    Ref<scene::Joint> joint;
    std::optional<Formula> angle;         ///< [rad]
    std::optional<Formula> displacement;  ///< [m]
    std::optional<FormulaVec3> velocity;  ///< of the body, with which it begins [m/s]
    Formula rate = 0;                     ///< of the joint, a hinge [rad/s]
    Formula speed = 0;                    ///< of the joint, a slider [m/s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body,
          Field::text().says("Body that begins the trial elsewhere than the scene has it."));
        v("position", position,
          Field::length().within(-100, 100).says("Where its origin is then."));
        v("joint", joint,
          Field::text().says(
              "Joint, in place of a body, that begins the trial elsewhere than at 0, "
              "with all that hangs on its second body."));
        v("angle", angle,
          Field::of(Quantity::angle).within(-100, 100).says("Angle of that joint, a hinge, then."));
        v("displacement", displacement,
          Field::length().within(-100, 100).says("Displacement of that joint, a slider, then."));
        v("velocity", velocity,
          Field::of(Quantity::speed).within(-100, 100).says("Velocity that the body begins with."));
        v("rate", rate,
          Field::of(Quantity::angular_speed)
              .within(-1000, 1000)
              .says("Angular speed that the joint, a hinge, begins with."));
        v("speed", speed,
          Field::of(Quantity::speed)
              .within(-100, 100)
              .says("Speed that the joint, a slider, begins with."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A factor whose levels, crossed with those of the other factors, make the conditions.
struct Factor {
    std::string factor;               ///< name, in whose unit the levels are
    std::vector<std::string> levels;  ///< numbers, or texts
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("factor", factor,
          Field::text().required().says(
              "Name of the factor, which may end in the unit of its levels."));
        v("levels", levels,
          Field::text().required().says("Its levels, all of them numbers or all of them texts."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// How trials differ: regions and perturbations that replace those of the same name, where bodies
/// begin, and how things look.
struct Condition {
    std::string name;
    Node factors;             ///< its level of each factor
    Ref<scene::Body> object;  ///< whose lifts are measured; empty: the scene's object
    std::vector<BodyPlace> places;
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    std::vector<LookSpec> look;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says(
              "Name of the condition; with cross, of the one that this is added to."));
        v("factors", factors,
          says("A level of each factor, by the factor's name; cross gives them by itself."));
        v("object", object, says("Body whose lifts are measured; left out, the scene's object."));
        v("places", places, says("Bodies that begin the trial elsewhere."));
        v("regions", regions, says("Regions in place of those of the same name."));
        v("perturbations", perturbations,
          says("Perturbations in place of those of the same name."));
        v("look", look, says("Colours and sizes in these trials."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

enum class Order { sequential, shuffled, latin_square, counterbalanced };
constexpr auto enum_names(Order) {
    return std::array{"sequential", "shuffled", "latin_square", "counterbalanced"};
}

using rows::TrialKind;

/// Trials of another kind, inserted at random places of a block.
struct Insert {
    TrialKind kind = TrialKind::catch_trial;
    int count = 1;
    int gap = 1;  ///< least number of other trials between two of them
    Refs<PerturbationSpec> perturb;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, says("What the trials are for the analysis."));
        v("count", count,
          Field::number().within(1, 10000).required().says("How many trials are inserted."));
        v("gap", gap,
          Field::number().within(1, 10000).says(
              "Least number of other trials between two of them."));
        v("perturb", perturb, says("Perturbations of these trials; left out, there are none."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Block {
    std::string name;
    TrialKind kind = TrialKind::baseline;
    RefList<Condition> conditions;   ///< empty: all
    int repeats = 1;                 ///< number of times that each condition is done
    Order order = Order::shuffled;   ///< order of the conditions, made anew in each repeat
    Refs<PerturbationSpec> perturb;  ///< which act together
    int ramp = 0;  ///< trials over which their share rises from 0 to 1; 0: at once
    RefList<ProcedureSpec> procedures;  ///< if given, the block consists of their trials, mixed
    std::vector<Insert> insert;
    std::string until;            ///< a condition on variables, which ends the block; empty: none
    double rest = 0;              ///< break before the block, unless it is the first [s]
    std::vector<PageSpec> pages;  ///< shown before the block begins
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the block."));
        v("kind", kind, says("What its trials are for the analysis."));
        v("conditions", conditions, says("Conditions that the block has; left out, all."));
        v("repeats", repeats,
          Field::number().within(1, 10000).says("How often each of the conditions is done."));
        v("order", order, says("Order of the conditions, made anew in each repeat."));
        v("perturb", perturb,
          says("Perturbations that act together in its trials, eight at most; left "
               "out, there are none."));
        v("ramp", ramp,
          Field::number().within(0, 100000).says(
              "Number of trials in which the perturbations' share rises to 1; 0 is at once."));
        v("procedures", procedures,
          says("Procedures whose trials, mixed, the block consists of, in place of "
               "conditions and repeats."));
        v("insert", insert,
          says("Further trials of another kind, at random places but not first."));
        v("until", until,
          says("Condition on variables after which the block's other trials are left out."));
        v("rest", rest,
          Field::of(Quantity::time)
              .within(0, 3600)
              .says("Break before the block, unless it is the session's first."));
        v("pages", pages,
          says("Pages in place of the scene before the block, one after the other."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// When a trial that failed is done again.
enum class Redo { never, next, end_of_block, random };
constexpr auto enum_names(Redo) {
    return std::array{"never", "next", "end_of_block", "random"};
}

/// What is measured of a reach, once in each trial, in one of its states.
///
/// angle    about `axis`, right-handed, from the direction of `to` to the direction of the handle
///          when it is `distance` from `from`; both seen from `from`
/// extent   how far the handle has gone along the line from `from` to `to` when its first stroke
///          ends
enum class Measure { angle, extent };
constexpr auto enum_names(Measure) {
    return std::array{"angle", "extent"};
}

struct ReachMeasure {
    Measure measure = Measure::angle;
    Ref<scene::Finger> finger;  ///< empty: the first
    Ref<Region> from;
    Ref<Region> to;
    Ref<State> during;
    double distance = 0.05;    ///< [m]
    std::optional<Vec3> axis;  ///< unset: the axis of the first perturbation that has one, or z
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("measure", measure,
          says("Whether the reach's direction is measured or how far its first stroke goes."));
        v("finger", finger, says("Finger that reaches; left out, the scene's first."));
        v("from", from, Field::text().required().says("Region that the reach begins in."));
        v("to", to, Field::text().required().says("Region that it goes to."));
        v("during", during, Field::text().required().says("State in which it is measured."));
        v("distance", distance,
          Field::length().within(1e-4, 10).says(
              "Distance from the start at which the angle is taken."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Axis about which angles count, right-handed; left out, that of the first "
                    "perturbation that has one, or z."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Fingers that conditions judge together.
struct Hand {
    std::string name;
    RefList<scene::Finger> fingers;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name by which conditions take these fingers together."));
        v("fingers", fingers, Field::text().required().says("Fingers of the hand."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A number that the rules change between trials.
struct Variable {
    std::string name;
    double start = 0;  ///< at the session's start, in the unit that the name ends in
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the variable, which may end in its unit."));
        v("start", start,
          Field::number().within(-1e9, 1e9).says(
              "Its value at the session's start, in that unit."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// What becomes of a variable when a trial ends.
struct Rule {
    std::string when;  ///< a condition; empty: always
    Ref<Variable> set;
    std::string to;  ///< expression
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("when", when, says("Condition on the ended trial; left out, the rule always holds."));
        v("set", set, Field::text().required().says("Variable that is set."));
        v("to", to, Field::text().required().says("Expression of its new value."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Task {
    std::vector<Hand> hands;
    std::vector<DrawSpec> draws;
    std::vector<Variable> variables;
    std::vector<Rule> after_trial;  ///< in their order
    std::vector<Factor> cross;      ///< makes the conditions
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    std::vector<SoundSpec> sounds;
    std::vector<State> states;  ///< each trial begins in the first one
    /// Empty: one condition without a name. With factors that are crossed, what is to be added to
    /// the conditions that they make.
    std::vector<Condition> conditions;
    std::vector<Condition> rounds;  ///< the blocks are done once in each round; empty: once
    Order round_order = Order::sequential;
    std::vector<ProcedureSpec> procedures;
    std::vector<Block> blocks;
    Redo redo = Redo::end_of_block;
    int most_attempts = 3;  ///< largest number of attempts at a trial
    /// Time for which a feedback stays: no message replaces it, and no trial begins [s].
    double feedback = 1;
    bool feedback_beside = false;    ///< it is a line below the message, for this time
    std::vector<std::string> lines;  ///< texts below the message, throughout
    std::optional<ReachMeasure> reach;
    std::vector<std::string> measures;  ///< names of kMeasureTable
    std::vector<OwnMeasure> own_measures;
    std::optional<Movement> movement;  ///< that `measures` are taken of
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("hands", hands, says("Groups of fingers that conditions can name."));
        v("draws", draws, says("Numbers and texts that are drawn for each trial."));
        v("variables", variables, says("Numbers that rules change between trials."));
        v("after_trial", after_trial,
          says("Rules that set variables when a trial ends, in their order."));
        v("cross", cross, says("Factors whose levels, crossed, make the conditions."));
        v("regions", regions,
          says("Named spheres, 16 at most, where hands have to be and which can be shown."));
        v("perturbations", perturbations,
          says("Named changes of what is shown, felt or pushed, which blocks and inserts choose."));
        v("sounds", sounds, says("Sounds, 32 at most, which states and exits name."));
        v("states", states,
          Field::text().required().says("States that each trial runs through, from the first on."));
        v("conditions", conditions,
          says("How trials differ; left out, there is one condition without a name."));
        v("rounds", rounds, says("Conditions as well: the blocks are done once for each."));
        v("round_order", round_order, says("Order of the rounds."));
        v("procedures", procedures,
          says("Adaptive procedures, which choose the share of a perturbation by the "
               "answers so far."));
        v("blocks", blocks, Field::text().required().says("Blocks of trials, in their order."));
        v("redo", redo, says("When a trial that is to be done again is done."));
        v("most_attempts", most_attempts,
          Field::number().within(1, 100).says("Largest number of attempts at one trial."));
        v("feedback", feedback,
          Field::of(Quantity::time)
              .within(0, 60)
              .says("How long feedback is shown before the next message or trial."));
        v("feedback_beside", feedback_beside,
          says("Whether feedback is a line below the message for that time, and "
               "holds no message back."));
        v("lines", lines, says("Texts below the message throughout the session, two at most."));
        v("reach", reach, says("What is measured of a reach, once in each trial."));
        v("measures", measures,
          says("Names of the [measures of behaviour](measures-of-behaviour.md) that "
               "are reported for each attempt."));
        v("own_measures", own_measures,
          says("Expressions of one's own, reported of each attempt."));
        v("movement", movement,
          says("Movement that the measures are taken of; what it leaves out is taken from reach."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

}  // namespace dihaptic::task
