// The traits of a simulated person. population.h defines how they are distributed over people.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/field.h"
#include "model/adaptation.h"
#include "model/psychometric.h"

namespace dihaptic::person {

/// Whether objects are felt directly or through a haptic device. Through a device, people grip
/// harder and learn weights more slowly (EMBC 2022).
enum class Objects { real, device };
constexpr auto enum_names(Objects) {
    return std::array{"real", "device"};
}

inline constexpr int kMostLaboratories = 1000;

/// README.md explains the effect of each trait. The files in populations/ give medians, spreads and
/// their sources.
struct Traits {
    std::string id;
    std::string population;  ///< title of the population from which the person was drawn
    std::string group;       ///< group in that population; empty if there are no groups
    int laboratory = 0;      ///< number of the person's laboratory; 0 for a median laboratory
    Objects objects = Objects::device;

    double visual_delay = 0;       ///< delay from an event on the screen to the response [s]
    double visual_noise = 0;       ///< SD of a perceived position, per axis [m]
    double reaction_time = 0;      ///< time from the cue to the movement [s]
    double reaction_noise = 0;     ///< SD of the reaction time over trials, as a share
    double tempo = 0;              ///< ratio of movement times to those in the experiment file
    double tempo_noise = 0;        ///< SD of the tempo over movements, as a share
    double direction_noise = 0;    ///< SD of a reach's direction, per axis across the reach [rad]
    double adapted_noise = 0;      ///< SD of a learned direction, as a share of what was learned
    double extent_noise = 0;       ///< SD of the length of a movement, as a share
    double online_correction = 0;  ///< share of a visible error that is corrected during the reach

    double fast_retention = 0;  ///< per reach; first of four values for adaptation to rotations
    double fast_learning = 0;
    double slow_retention = 0;
    double slow_learning = 0;
    double fast_limit = 0;      ///< error above which the fast process learns hardly more [rad]
    double slow_limit = 0;      ///< likewise for the slow process; 0 for no limit
    double generalisation = 0;  ///< generalisation width (SD) of the slow process [rad]
    double unseen_share = 0;    ///< share of what was learned that shows without a cursor

    double gain_retention = 0;  ///< per movement; for adaptation to scaled displays
    double gain_learning = 0;

    double force_fast_retention = 0;  ///< per reach; first of four values for adaptation to forces
    double force_fast_learning = 0;
    double force_slow_retention = 0;
    double force_slow_learning = 0;
    double force_noise = 0;  ///< SD over reaches of the force against an expected push, as a share
    double force_generalisation = 0;  ///< generalisation width (SD) of both force processes [rad]

    double safety_margin = 0;    ///< safety margin of the static grip force
    double least_grip = 0;       ///< smallest grip force, even for a very light object [N]
    double peak_grip = 0;        ///< ratio of the grip force at lift-off to the static grip force
    double grip_noise = 0;       ///< SD over lifts of the log of the grip force
    double preload_time = 0;     ///< time from touch to the onset of the load force [s]
    double load_time = 0;        ///< duration of the load phase at an expected weight of 0 [s]
    double load_time_rise = 0;   ///< increase of this duration per expected weight [s/N]
    double load_time_noise = 0;  ///< SD over lifts of the log of this duration
    double reflex_latency = 0;   ///< time from a touch, slip or load change to the response [s]
    double reflex_noise = 0;     ///< SD of the reflex latency over trials [s]
    double weight_learning = 0;  ///< share of a weight error that is corrected in the next lift
    double friction_error = 0;   ///< SD of the log of the ratio of perceived to true friction
    double skin_time = 0;       ///< time from touch until the skin senses friction; 0 for never [s]
    double mass_retention = 0;  ///< per movement; for adaptation to mass that causes no weight
    double mass_learning = 0;

    double answer_bias = 0;   ///< log of displayed over felt movement at which both seem equal
    double answer_sd = 0;     ///< SD of the psychometric function
    double answer_lapse = 0;  ///< share of wrong answers, even for a clear difference

    double hesitation_rate = 0;  ///< share of trials that start late
    double hesitation_time = 0;  ///< mean delay of a late trial [s]
    double slip_rate = 0;        ///< share of grips that are too weak
    double give_up_rate = 0;     ///< share of attempts that the person does not make

    model::TwoRate rotation() const {
        return {{fast_retention, fast_learning}, {slow_retention, slow_learning}};
    }
    model::TwoRate force() const {
        return {{force_fast_retention, force_fast_learning},
                {force_slow_retention, force_slow_learning}};
    }
    model::SingleRate gain() const { return {gain_retention, gain_learning}; }
    model::SingleRate mass() const { return {mass_retention, mass_learning}; }
    model::Psychometric answers() const {
        return {model::Sigmoid::normal, answer_bias, answer_sd, answer_lapse, answer_lapse};
    }

    template <class Visitor>
    void visit(Visitor& v) {
        const Field time = Field::of(Quantity::time).within(0, 60);
        const Field share = Field::number().within(0, 1);
        const Field angle = Field::of(Quantity::angle).within(0, 7);
        v("id", id);
        v("population", population);
        v("group", group);
        v("laboratory", laboratory, Field::number().within(0, kMostLaboratories));
        v("objects", objects);
        v("visual_delay", visual_delay, Field::of(Quantity::time).within(0, 1));
        v("visual_noise", visual_noise, Field::length().within(0, 1));
        v("reaction_time", reaction_time, time);
        v("reaction_noise", reaction_noise, share);
        v("tempo", tempo, Field::number().within(0.1, 10));
        v("tempo_noise", tempo_noise, share);
        v("direction_noise", direction_noise, angle);
        v("adapted_noise", adapted_noise, share);
        v("extent_noise", extent_noise, share);
        v("online_correction", online_correction, share);
        v("fast_retention", fast_retention, share);
        v("fast_learning", fast_learning, share);
        v("slow_retention", slow_retention, share);
        v("slow_learning", slow_learning, share);
        v("fast_limit", fast_limit, angle);
        v("slow_limit", slow_limit, angle);
        v("generalisation", generalisation, angle.positive());
        v("unseen_share", unseen_share, share);
        v("gain_retention", gain_retention, share);
        v("gain_learning", gain_learning, share);
        v("force_fast_retention", force_fast_retention, share);
        v("force_fast_learning", force_fast_learning, share);
        v("force_slow_retention", force_slow_retention, share);
        v("force_slow_learning", force_slow_learning, share);
        v("force_noise", force_noise, share);
        v("force_generalisation", force_generalisation, angle.positive());
        v("safety_margin", safety_margin, Field::number().within(0, 0.95));
        v("least_grip", least_grip, Field::of(Quantity::force).within(0, 100));
        v("peak_grip", peak_grip, Field::number().within(1, 10));
        v("grip_noise", grip_noise, share);
        v("preload_time", preload_time, time);
        v("load_time", load_time, time.positive());
        v("load_time_rise", load_time_rise, Field::number().within(0, 10));
        v("load_time_noise", load_time_noise, share);
        v("reflex_latency", reflex_latency, Field::of(Quantity::time).within(0, 1));
        v("reflex_noise", reflex_noise, time);
        v("weight_learning", weight_learning, share);
        v("friction_error", friction_error, share);
        v("skin_time", skin_time, Field::of(Quantity::time).within(0, 1));
        v("mass_retention", mass_retention, share);
        v("mass_learning", mass_learning, share);
        v("answer_bias", answer_bias, Field::number().within(-10, 10));
        v("answer_sd", answer_sd, Field::number().positive().at_most(10));
        v("answer_lapse", answer_lapse, Field::number().within(0, 0.5));
        v("hesitation_rate", hesitation_rate, share);
        v("hesitation_time", hesitation_time, time);
        v("slip_rate", slip_rate, share);
        v("give_up_rate", give_up_rate, share);
    }
};

}  // namespace dihaptic::person
