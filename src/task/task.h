// The task of an experiment file (docs/files.md): a small state machine that each trial runs
// through, what perturbs it, and the trials' order.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>

#include "hand/spec.h"
#include "task/perturbation.h"
#include "task/procedure_spec.h"

namespace dihaptic::task {

/// What ends a state.
enum class When {
    inside,    ///< a finger's handle is in a region
    outside,   ///< a finger's handle is not in a region
    touched,   ///< a finger presses a body
    released,  ///< no finger presses a body
    gripped,   ///< two fingers press a body
    lifted,    ///< a body is above its place by a height
    still,     ///< the finger, or all fingers, are slower than a speed
    key,       ///< the operator pressed a key
    button,    ///< a button of a finger's device is held
    trigger,   ///< a code came in from outside, on one of the rig's outlets
    time,      ///< the state's time is over
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
        comes = 512
    };
    const char* name;
    unsigned has;  ///< besides the fields of all
};
constexpr WhenRow kWhenTable[] = {
    {"inside", WhenRow::region | WhenRow::any_finger},
    {"outside", WhenRow::region | WhenRow::any_finger},
    {"touched", WhenRow::body | WhenRow::any_finger},
    {"released", WhenRow::body | WhenRow::any_finger},
    {"gripped", WhenRow::body},
    {"lifted", WhenRow::body | WhenRow::height},
    {"still", WhenRow::any_finger | WhenRow::speed},
    {"key", WhenRow::key | WhenRow::comes},
    {"button", WhenRow::button | WhenRow::finger | WhenRow::comes},
    {"trigger", WhenRow::code | WhenRow::comes},
    {"time", WhenRow::comes},
};
static_assert(std::size(kWhenTable) == static_cast<size_t>(When::time) + 1);
constexpr auto enum_names(When) {
    std::array<const char*, std::size(kWhenTable)> out{};
    std::transform(std::begin(kWhenTable), std::end(kWhenTable), out.begin(),
                   [](const WhenRow& row) { return row.name; });
    return out;
}

/// One way out of a state: to another, or out of the trial with an outcome.
struct Exit {
    When when = When::time;
    std::string region;  ///< inside, outside
    bool shown = false;  ///< inside, outside: judged by where the finger is displayed
    std::string body;    ///< touched, released, gripped, lifted
    std::string finger;  ///< if empty, the first finger; touched, released: any finger; still: all
                         ///< fingers; inside, outside: the middle of all
    double height = 0.02;  ///< lifted [m]
    double speed = 0.02;   ///< still [m/s]
    double hold = 0;       ///< time for which the condition must hold without a break; with
                           ///< When::time, the time in the state [s]
    std::string key;       ///< one letter or digit
    int button = 0;        ///< counted from 0
    int code = 0;          ///< trigger; 0: any
    std::string to;        ///< state
    std::string outcome;   ///< ends the trial with this outcome
    bool redo = false;     ///< the trial is to be done again
    std::string feedback;  ///< shown for Task::feedback at least, then until the next message
    Place place;

    /// Whether its condition has any of these (WhenRow::Has).
    bool has(unsigned any) const { return (kWhenTable[static_cast<size_t>(when)].has & any) != 0; }

    template <class Visitor>
    void visit(Visitor& v) {
        v("when", when, Field::text().required());
        if (has(WhenRow::region)) {
            v("region", region);
            v("shown", shown);
        }
        if (has(WhenRow::body)) v("body", body);
        if (has(WhenRow::finger | WhenRow::any_finger)) v("finger", finger);
        if (has(WhenRow::height)) v("height", height, Field::length().within(1e-4, 10));
        if (has(WhenRow::speed))
            v("speed", speed, Field::of(Quantity::speed).positive().at_most(100));
        v("hold", hold, Field::of(Quantity::time).within(0, 3600));
        if (has(WhenRow::key)) v("key", key);
        if (has(WhenRow::button)) v("button", button, Field::number().within(0, 31));
        if (has(WhenRow::code)) v("code", code, Field::number().within(0, 255));
        v("to", to);
        v("outcome", outcome);
        v("redo", redo);
        v("feedback", feedback);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A step of the simulated hand in a state: as in a script, or to a region.
struct HandStep {
    double duration = 0;             ///< [s]
    std::string reach;               ///< region that the hand's centre goes to
    Vec3 move = Vec3::Zero();        ///< displacement of the hand's centre [m]
    std::optional<double> aperture;  ///< aperture at the end [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("duration", duration, Field::of(Quantity::time).positive().at_most(3600).required());
        v("reach", reach);
        v("move", move, Field::length().within(-hand::kFarthest, hand::kFarthest));
        v("aperture", aperture, Field::length().within(0, hand::kFarthest));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct State {
    std::string name;
    std::vector<std::string> show;  ///< regions shown while the state lasts
    bool perturbed = true;          ///< the trial's perturbation acts
    std::string message;
    int marker = 0;              ///< event code on entering; 0: none
    std::vector<Exit> exits;     ///< the first whose condition holds is taken
    std::vector<HandStep> hand;  ///< steps of the simulated hand from entering the state on
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("show", show);
        v("perturbed", perturbed);
        v("message", message);
        v("marker", marker, Field::number().within(0, 255));
        v("exits", exits);
        v("hand", hand);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Where a body begins the trial, in place of its position in the scene.
struct BodyPlace {
    std::string body;
    Vec3 position = Vec3::Zero();  ///< [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, Field::text().required());
        v("position", position, Field::length().within(-100, 100).required());
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// How trials differ: regions and perturbations that replace those of the same name, and where
/// bodies begin.
struct Condition {
    std::string name;
    std::vector<BodyPlace> places;
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("places", places);
        v("regions", regions);
        v("perturbations", perturbations);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

enum class Order { sequential, shuffled, latin_square, counterbalanced };
constexpr auto enum_names(Order) {
    return std::array{"sequential", "shuffled", "latin_square", "counterbalanced"};
}

enum class TrialKind { practice, baseline, perturbed, catch_trial, error_clamp, washout };
constexpr auto enum_names(TrialKind) {
    return std::array{"practice", "baseline", "perturbed", "catch", "error_clamp", "washout"};
}

/// Trials of another kind, inserted at random places of a block.
struct Insert {
    TrialKind kind = TrialKind::catch_trial;
    int count = 1;
    std::string perturb;  ///< perturbation; empty: none
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind);
        v("count", count, Field::number().within(1, 10000).required());
        v("perturb", perturb);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Block {
    std::string name;
    TrialKind kind = TrialKind::baseline;
    std::vector<std::string> conditions;  ///< empty: all
    int repeats = 1;                      ///< number of times that each condition is done
    Order order = Order::shuffled;        ///< order of the conditions, made anew in each repeat
    std::string perturb;                  ///< a perturbation; empty: none
    int ramp = 0;  ///< trials over which its share rises from 0 to 1; 0: at once
    std::vector<std::string> procedures;  ///< if given, the block consists of their trials, mixed
    std::vector<Insert> insert;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("kind", kind);
        v("conditions", conditions);
        v("repeats", repeats, Field::number().within(1, 10000));
        v("order", order);
        v("perturb", perturb);
        v("ramp", ramp, Field::number().within(0, 100000));
        v("procedures", procedures);
        v("insert", insert);
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
    std::string finger;        ///< empty: the first
    std::string from;          ///< region
    std::string to;            ///< region
    std::string during;        ///< state
    double distance = 0.05;    ///< [m]
    std::optional<Vec3> axis;  ///< unset: the axis of the first perturbation that has one, or z
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("measure", measure);
        v("finger", finger);
        v("from", from, Field::text().required());
        v("to", to, Field::text().required());
        v("during", during, Field::text().required());
        v("distance", distance, Field::length().within(1e-4, 10));
        v("axis", axis, Field::number().within(-1000, 1000));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Task {
    std::vector<Region> regions;
    std::vector<PerturbationSpec> perturbations;
    std::vector<State> states;          ///< each trial begins in the first one
    std::vector<Condition> conditions;  ///< empty: one condition without a name
    std::vector<Condition> rounds;      ///< the blocks are done once in each round; empty: once
    Order round_order = Order::sequential;
    std::vector<ProcedureSpec> procedures;
    std::vector<Block> blocks;
    Redo redo = Redo::end_of_block;
    int most_attempts = 3;  ///< largest number of attempts at a trial
    /// Time for which a feedback stays: no message replaces it, and no trial begins [s].
    double feedback = 1;
    std::optional<ReachMeasure> reach;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("regions", regions);
        v("perturbations", perturbations);
        v("states", states, Field::text().required());
        v("conditions", conditions);
        v("rounds", rounds);
        v("round_order", round_order);
        v("procedures", procedures);
        v("blocks", blocks, Field::text().required());
        v("redo", redo);
        v("most_attempts", most_attempts, Field::number().within(1, 100));
        v("feedback", feedback, Field::of(Quantity::time).within(0, 60));
        v("reach", reach);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

}  // namespace dihaptic::task
