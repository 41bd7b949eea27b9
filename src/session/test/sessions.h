// Creates short sessions with the same trials, each moved by a different mover of a simulated hand.
#pragma once

#include <gtest/gtest.h>

#include "person/population.h"
#include "session/record.h"
#include "session/test/reaches.h"

namespace dihaptic::session {

using recording::Mover;

struct Sessions {
    Files files;

    Plan plan(Mover mover, const std::string& participant = "S07") {
        Request request = files.request(1, participant);
        request.mouse = mover == Mover::mouse;
        Plan plan = make_plan(request);
        if (mover == Mover::simulated_person) {
            const auto traits = person::draw_person(person::Objects::device, 1, participant);
            sit_down(plan, traits);
        }
        return plan;
    }
    /// Runs a session, which ends by itself or, with `cut`, after its first trial. A session moved
    /// by mouse is stopped, since nobody moves the mouse.
    std::string make(Mover mover, bool cut = false, const std::string& participant = "S07") {
        RunOptions options;
        options.out = files.folder.file("sessions");
        options.participant.id = participant;
        std::atomic<bool> stop{false};
        const auto look = [&](double share) {
            stop = stop || mover == Mover::mouse || (cut && share > 0.1);
        };
        // on the real clock, the session is stopped at the right moment
        if (cut || mover == Mover::mouse) options.clock = Clock::real;
        return record(plan(mover, participant), options, stop, look).folder;
    }
};

}  // namespace dihaptic::session
