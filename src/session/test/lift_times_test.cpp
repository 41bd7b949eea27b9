// Compares the times found for grip-lifts with the raw frames, for 40 g to 1 kg, on three surfaces,
// with grips that hardly hold and grips that crush. Times found from contacts must be right to 2
// ms; times found from forces are not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/lifts.h"
#include "recording/raw_log.h"
#include "session/session_run.h"
#include "testing/files.h"

namespace dihaptic::session::lift_times_test {
namespace {

using rows::EventRule;
using Lift = rows::LiftRow;

constexpr double kGravity = 9.81;
constexpr int kTable = 0;
constexpr int kBlock = 1;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Grasp {
    double mass;      // [kg]
    double friction;  // friction coefficient between block and fingers
    double margin;    // grip force relative to the least that friction requires
};

/// Returns an experiment with a hand so stiff that targets 15 mm inside each face produce the grip
/// force. The devices add a spring of 3000 N/m in series.
std::string experiment_of(const Grasp& g) {
    const double grip = g.margin * g.mass * kGravity / (2 * g.friction);
    const double both = grip / 0.015;
    const double hand = both * 3000 / (3000 - both);
    return fmt::format(R"(title: a lift
scene: scene.yaml
rig: rig.yaml
settings: {{ coupling: {{ stiffness_N_m: 3000 }} }}
hand:
  centre_mm: [0, 0, 20]
  aperture_mm: 85
  impedance: {{ stiffness_N_m: {:.3f}, damping_Ns_m: {:.3f} }}
  script:
    - {{ name: close, duration_s: 0.5, aperture_mm: 10 }}
    - {{ name: wait, duration_s: 0.2 }}
    - {{ name: lift, duration_s: 0.7, move_mm: [0, 0, 80] }}
    - {{ name: hold, duration_s: 1 }}
    - {{ name: lower, duration_s: 0.8, move_mm: [0, 0, -82] }}
    - {{ name: open, duration_s: 0.5, aperture_mm: 85 }}
    - {{ name: rest, duration_s: 0.3 }}
)",
                       hand, std::max(3.0, std::sqrt(hand * 0.075)));
}

std::string scene_of(const Grasp& g) {
    return fmt::format(R"(title: a block
object: block
bodies:
  - {{ name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes, friction: 0.8 }}
  - {{ name: block, shape: box, size_mm: [40, 40, 40], mass_g: {0:.1f}, position_mm: [0, 0, 20], friction: {1:.3f} }}
fingers:
  - {{ name: thumb, shape: box, size_mm: [5, 20, 20], mass_g: 1, friction: {1:.3f} }}
  - {{ name: index, shape: box, size_mm: [5, 20, 20], mass_g: 1, friction: {1:.3f} }}
)",
                       1e3 * g.mass, g.friction);
}

const char* const kRig = R"(title: strong
devices:
  - { finger: thumb, backend: simulated, options: { peak_force_N: 60 } }
  - { finger: index, backend: simulated, options: { peak_force_N: 60 } }
)";

/// Times found independently of the analysis code: from the block's contacts with fingers and
/// table, the table's force, and the block's height.
struct Truth {
    double touch = kNone, load_onset = kNone, lift_off = kNone, replacement = kNone;  // [s]
};

struct Seen {
    double time, height, table, fingers;  // forces on the block [N]
};

Truth truth_of(const std::vector<Seen>& seen, double weight) {
    Truth out;
    double top = 0;
    for (const Seen& s : seen) top = std::max(top, s.height - seen.front().height);
    size_t high = 0, low = 0;  // first and last sample at half the height
    for (size_t i = 0; i < seen.size(); ++i) {
        if (seen[i].height - seen.front().height < top / 2) continue;
        if (high == 0) high = i;
        low = i;
    }
    for (size_t i = 0; i < seen.size(); ++i) {
        if (std::isnan(out.touch) && seen[i].fingers > 0) out.touch = seen[i].time;
        if (i < high && seen[i].table > 0) out.lift_off = seen[i + 1].time;
        if (i < high && seen[i].table >= 0.98 * weight) out.load_onset = seen[i + 1].time;
        if (i > low && seen[i].table > 0 && std::isnan(out.replacement))
            out.replacement = seen[i].time;
    }
    return out;
}

struct Found {
    Truth truth;
    Lift contact, force;
};

Found lift(const Grasp& g) {
    const testing::TemporaryFolder folder;
    folder.write("scene.yaml", scene_of(g));
    folder.write("rig.yaml", kRig);
    Request request;
    request.file = folder.write("lift.yaml", experiment_of(g));
    RunOptions options;
    options.out = folder.file("sessions");
    const std::atomic<bool> go_on{false};
    const RunResult result = run_session(make_plan(request), options, go_on, {});
    recording::RawLogReader log(recording::SessionFolder::open(result.folder).raw_log());
    analysis::GraspTrace trace(kBlock, log.head().tick);
    std::vector<Seen> seen;
    while (const frame::Frame* frame = log.next()) {
        trace.add(*frame);
        const frame::BodyFrame& block = frame->bodies[kBlock];
        Seen s{seconds(frame->time), block.X_WB.p.z(), 0, 0};
        for (const frame::ContactFrame& c : frame->contacts) {
            if (c.a != kBlock && c.b != kBlock) continue;
            (c.a + c.b - kBlock == kTable ? s.table : s.fingers) += c.normal_force;
        }
        if (!block.awake)
            s.table = g.mass * kGravity;  // a sleeping block lies on the table but has no contacts
        seen.push_back(s);
    }
    const double friction[] = {g.friction, g.friction};
    const Vec3 gravity(0, 0, -kGravity);
    return {truth_of(seen, g.mass * kGravity), find_lift(trace, gravity, friction),
            find_lift(trace, gravity, friction, EventRule::force)};
}

/// Largest error of each time [s]; infinite if a time is missing.
struct Worst {
    double touch = 0, onset = 0, off = 0, replaced = 0, preload = 0, loading = 0;

    static void take(double& worst, double found, double truth) {
        const double off = std::abs(found - truth);
        worst = std::max(worst, std::isnan(off) ? INFINITY : off);
    }
    void add(const Lift& lift, const Truth& truth) {
        take(touch, lift.touch, truth.touch);
        take(onset, lift.load_onset, truth.load_onset);
        take(off, lift.lift_off, truth.lift_off);
        take(replaced, lift.replacement, truth.replacement);
        take(preload, lift.preload, truth.load_onset - truth.touch);
        take(loading, lift.loading, truth.lift_off - truth.load_onset);
    }
    std::string text() const {
        return fmt::format(
            "touch {:.1f}, load onset {:.1f}, lift-off {:.1f}, replacement {:.1f}, preload {:.1f}, "
            "loading {:.1f} ms",
            1e3 * touch, 1e3 * onset, 1e3 * off, 1e3 * replaced, 1e3 * preload, 1e3 * loading);
    }
};

TEST(LiftTimes, AreThoseOfTheContactsFrom40gTo1kg) {
    Worst contact, force;
    for (const double mass : {0.04, 0.06, 0.1, 0.2, 0.4, 0.8, 1.0}) {
        for (const double friction : {1.2, 0.7, 0.35}) {
            for (const double margin : {1.4, 3.0}) {
                SCOPED_TRACE(
                    fmt::format("{} kg, friction {}, grip {} times", mass, friction, margin));
                const Found found = lift({mass, friction, margin});
                EXPECT_EQ(found.contact.rule, EventRule::contact);
                EXPECT_EQ(found.force.rule, EventRule::force);
                EXPECT_EQ(found.contact.mark, "complete");
                Worst here;
                here.add(found.contact, found.truth);
                EXPECT_LE(here.touch, 2e-3) << here.text();
                EXPECT_LE(here.onset, 2e-3) << here.text();
                EXPECT_LE(here.off, 2e-3) << here.text();
                EXPECT_LE(here.replaced, 2e-3) << here.text();
                EXPECT_LE(here.preload, 4e-3) << here.text();
                EXPECT_LE(here.loading, 4e-3) << here.text();
                contact.add(found.contact, found.truth);
                force.add(found.force, found.truth);
            }
        }
    }
    RecordProperty("worst_by_contact", contact.text());
    RecordProperty("worst_by_force", force.text());
    fmt::print("worst by contact: {}\nworst by force:   {}\n", contact.text(), force.text());
    // where traces have contacts, the rule that uses them is far more accurate
    EXPECT_GT(force.touch, 10 * contact.touch);
}

}  // namespace
}  // namespace dihaptic::session::lift_times_test
