// Makes short sessions of the same trials, moved by each kind of mover of a simulated hand.
#pragma once

#include <gtest/gtest.h>

#include "analysis/session_report.h"
#include "experiment/test/reaches.h"
#include "person/person.h"
#include "person/population.h"

namespace dihaptic::session {

using experiment::kGoOn;
using recording::Mover;

struct Sessions {
    experiment::Files files;

    experiment::Plan plan(Mover mover, const std::string& participant = "S07") {
        experiment::Request request = files.request(1, participant);
        request.mouse = mover == Mover::mouse;
        experiment::Plan plan = experiment::make_plan(request);
        if (mover == Mover::simulated_person) {
            const auto traits = person::draw_person(person::Objects::device, 1, participant);
            person::sit_down(plan, traits);
        }
        return plan;
    }
    /// Makes a session, which ends by itself or, with `cut`, after the first of its trials. A
    /// session moved by mouse is stopped, since nobody moves the mouse.
    std::string make(Mover mover, bool cut = false, const std::string& participant = "S07") {
        experiment::RunOptions options;
        options.out = files.folder.file("sessions");
        options.participant.id = participant;
        std::atomic<bool> stop{false};
        const auto look = [&](double share) {
            stop = stop || mover == Mover::mouse || (cut && share > 0.1);
        };
        // on the real clock the session is cut at the right place
        if (cut) options.clock = experiment::Clock::real;
        const auto result = experiment::run_session(plan(mover, participant), options, stop, look);
        analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
        return result.folder;
    }
};

}  // namespace dihaptic::session
