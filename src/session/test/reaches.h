// A small reaching experiment in its own folder, which tests modify and run.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "session/check.h"
#include "session/session_run.h"
#include "testing/files.h"

namespace dihaptic::session {

inline const std::atomic<bool> kGoOn{false};

inline const char* const kScene = R"(bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
)";

/// Reaches of 50 mm with a rotation, a clamp and a channel, and with every kind of transition that
/// needs no object.
inline const char* const kReaches = R"(title: Reaches
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50, 0, 120], radius_mm: 6 }
    - { name: shell, position_mm: [0, 0, 120], radius_mm: 45 }
  perturbations:
    - name: rotation
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }
    - name: clamp
      visual: { moves: [proxies], about: start, toward: target }
    - name: channel
      field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, damping_Ns_m: 5 }
  states:
    - name: home
      show: [start]
      perturbed: no
      message: Go home
      exits:
        - { when: inside, region: start, hold_s: 0.2, to: reach }
        - { when: time, after_s: 5, outcome: lost, redo: yes }
      simulated_hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      marker: 7
      exits:
        - { when: outside, region: shell, outcome: reached, feedback: Good }
        - { when: time, after_s: 1, outcome: too slow, redo: yes }
      simulated_hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  conditions:
    - name: right
    - name: far
      regions: [{ name: target, position_mm: [0, 50, 120], radius_mm: 6 }]
  redo: next
  blocks:
    - { name: before, kind: baseline, repeats: 1 }
    - { name: turned, kind: perturbed, perturb: rotation, repeats: 2, ramp: 2, insert: [{ kind: catch, count: 1 }] }
    - { name: clamped, kind: visual_clamp, perturb: clamp, repeats: 1, order: sequential }
)";

struct Files {
    testing::TemporaryFolder folder;
    std::string scene = kScene;
    std::string experiment = kReaches;

    Files() = default;
    void replace(const std::string& what, const std::string& by) {
        const size_t at = experiment.find(what);
        ASSERT_NE(at, std::string::npos) << what;
        experiment.replace(at, what.size(), by);
    }
    /// Keeps only two trials, because all trials together take twelve seconds on the real clock.
    void keep_first_block() { experiment.resize(experiment.find("    - { name: turned")); }
    Request request(uint64_t seed = 1, const std::string& participant = "S01") {
        folder.write("scene.yaml", scene);
        Request request;
        request.file = folder.write("experiment.yaml", experiment);
        request.seed = seed;
        request.participant = participant;
        return request;
    }
    RunResult run(const Plan& plan, const std::atomic<bool>& stop = kGoOn) {
        RunOptions options;
        options.out = folder.file("sessions");
        return run_session(plan, options, stop, {});
    }
};

/// A mistake in a file: `what` is replaced with `by`, and the error message must contain `said`.
struct Mistake {
    const char* what;
    const char* by;
    const char* said;
};

/// Checks that the file with the mistake is refused, with file, line and remedy.
inline void expect_refused(Files& files, const Mistake& mistake) {
    files.replace(mistake.what, mistake.by);
    Diagnostics diagnostics;
    check_file(files.request().file, diagnostics);
    bool found = false;
    std::string all;
    for (const Problem& p : diagnostics.problems()) {
        all += p.text() + "\n";
        if (p.severity != Severity::error || p.text().find(mistake.said) == std::string::npos)
            continue;
        found = true;
        EXPECT_GT(p.place.line, 0) << p.text();
        EXPECT_NE(p.place.file.find("experiment.yaml"), std::string::npos) << p.text();
        EXPECT_FALSE(p.remedy.empty()) << p.text();
    }
    EXPECT_TRUE(found) << "not said: " << mistake.said << "\nbut:\n" << all;
}

}  // namespace dihaptic::session
