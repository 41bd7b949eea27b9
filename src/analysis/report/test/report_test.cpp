// Tests reports of tables with known figures.
#include "analysis/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/adaptation.h"
#include "analysis/generalisation.h"
#include "analysis/report/session_data.h"
#include "analysis/report/statistics.h"
#include "base/number.h"
#include "base/random.h"
#include "testing/files.h"

namespace dihaptic::analysis::report_test {
namespace {

TEST(Statistics, OfAKnownSample) {
    const double x[] = {4, 1, 3, 2, 5, std::nan("")};
    const Sample all = sample(x);
    EXPECT_EQ(all.count, 5);
    EXPECT_DOUBLE_EQ(all.mean, 3);
    EXPECT_DOUBLE_EQ(all.sd, std::sqrt(2.5));
    EXPECT_DOUBLE_EQ(all.median, 3);
    EXPECT_DOUBLE_EQ(all.quartiles.low, 2);
    // Student's t for 4 degrees of freedom is 2.776445 at 97.5 %
    EXPECT_NEAR(all.mean_interval.high - 3, 2.7764451 * std::sqrt(2.5 / 5), 1e-6);
    EXPECT_TRUE(std::isnan(sample(std::span(x).first(1)).mean_interval.low));
    EXPECT_EQ(sample({}).count, 0);
    EXPECT_TRUE(std::isnan(sample({}).mean));
    EXPECT_EQ(in_words({std::nan(""), std::nan("")}), "-");
}

/// The trials of a person who adapts according to a two-rate model.
struct Learner {
    struct Kind {
        std::string block;
        std::string kind;
    };
    std::vector<model::AdaptationTrial> schedule{};
    std::vector<Kind> kinds{};

    void add(int count, const std::string& block, const std::string& kind, double f) {
        for (int i = 0; i < count; ++i) {
            schedule.push_back({f, kind == "visual_clamp"});
            kinds.push_back({block, kind});
        }
    }
    /// Returns the text of trials.csv.
    std::string trials(const model::TwoRate& rates, double bias, size_t unreached = 1000) {
        std::string out = "trial_num,block,kind,round,hand_angle_deg,shown_angle_deg\n";
        // in a trial without a reach, no error is seen
        if (unreached < schedule.size()) schedule[unreached].clamp = true;
        const auto x = model::compensation(rates, schedule);
        for (size_t i = 0; i < x.size(); ++i) {
            const double hand = -(x[i] + bias);
            const double shown = schedule[i].clamp ? 0 : hand + schedule[i].perturbation;
            out += number_text(i + 1) + "," + kinds[i].block + "," + kinds[i].kind + ",about z," +
                   (i == unreached ? "," : number_text(hand) + "," + number_text(shown)) + "\n";
        }
        return out;
    }
};

/// Returns trials.csv for a rotation that is learned, clamped and washed out.
std::string trials_of(const model::TwoRate& rates, double rotation, double bias) {
    Learner learner;
    learner.add(16, "baseline", "baseline", 0);
    learner.add(30, "perturbed", "perturbed", rotation);
    learner.add(1, "catch", "catch", 0);
    learner.add(29, "perturbed", "perturbed", rotation);
    learner.add(20, "visual_clamp", "visual_clamp", 0);
    learner.add(10, "washout", "washout", 0);
    return learner.trials(rates, bias, 20);
}

TEST(Adaptation, IsFoundInTrialsWithTheRatesThatMadeIt) {
    testing::TemporaryFolder folder;
    const double bias = 1.5;
    const rows::TrialFile trials(
        folder.write("trials.csv", trials_of(model::kSmith2006, -30, bias)));
    const auto curves = adaptation_curves(trials);
    ASSERT_EQ(curves.size(), 1u);
    const AdaptationCurve& curve = curves[0];
    EXPECT_EQ(curve.round, "about z");
    EXPECT_NEAR(curve.perturbation(), -30, 1e-5);
    EXPECT_TRUE(std::isnan(curve.trials[20].compensation));
    const auto at = curve.windows();
    EXPECT_NEAR(at.baseline.mean, bias, 1e-5);
    EXPECT_LT(at.late.mean, at.early.mean);
    EXPECT_NEAR(at.catch_trials.mean, curve.trials[46].compensation, 1e-12);
    double washout = 0;  // mean over the first eight trials of washout
    for (size_t i = 96; i < 104; ++i) washout += curve.trials[i].compensation / 8;
    EXPECT_NEAR(at.washout_first.mean, washout, 1e-12);
    const auto fits = fit_adaptation(curve);
    ASSERT_TRUE(fits);
    EXPECT_LT(fits->two_rate.residual_sd, 0.05);
    EXPECT_NEAR(fits->two_rate.rates.slow.retention, 0.992, 0.003);
    EXPECT_NEAR(fits->two_rate.rates.fast.learning, 0.21, 0.02);
}

TEST(Adaptation, SavingsAreWhatIsThereSoonerWhenTheSameIsLearnedAgain) {
    testing::TemporaryFolder folder;
    Learner learner;
    learner.add(10, "before", "baseline", 0);
    learner.add(40, "first", "perturbed", -30);
    learner.add(12, "washout", "washout", 0);
    learner.add(40, "again", "perturbed", -30);
    const rows::TrialFile trials(folder.write("trials.csv", learner.trials(model::kSmith2006, 2)));
    const auto curve = adaptation_curves(trials).at(0);
    double first = 0;
    double again = 0;
    for (size_t i = 0; i < 8; ++i) {
        first += curve.trials[10 + i].compensation / 8;
        again += curve.trials[62 + i].compensation / 8;
    }
    EXPECT_LT(again, first - 1);  // both values are negative, so more is learned
    EXPECT_NEAR(curve.windows().savings.mean, first - again, 1e-12);
    EXPECT_TRUE(std::isnan(curve.windows().rebound.mean));
}

TEST(Adaptation, ReboundIsWhatComesBackInAClampAfterTheOpposite) {
    testing::TemporaryFolder folder;
    Learner learner;
    learner.add(64, "before", "baseline", 0);
    learner.add(160, "learn", "perturbed", 30);
    learner.add(16, "reverse", "perturbed", -30);
    learner.add(48, "clamp", "visual_clamp", 0);
    const rows::TrialFile trials(folder.write("trials.csv", learner.trials(model::kSmith2006, 0)));
    const auto curve = adaptation_curves(trials).at(0);
    const auto& t = curve.trials;
    double last = 0;
    for (size_t i = t.size() - 8; i < t.size(); ++i) last += t[i].compensation / 8;
    const double before = (t[238].compensation + t[239].compensation) / 2;
    EXPECT_GT(last - before, 3);
    EXPECT_NEAR(curve.windows().rebound.mean, last - before, 1e-12);
    EXPECT_TRUE(std::isnan(curve.windows().savings.mean));
}

TEST(Generalisation, IsToldByProbesInDirectionsThatWereNotTrained) {
    testing::TemporaryFolder folder;
    std::string list =
        "reach_finger,reach_from_x_mm,reach_from_y_mm,reach_from_z_mm,reach_to_x_mm,"
        "reach_to_y_mm,reach_to_z_mm\n";
    std::string trials = "trial_num,kind,condition,round,hand_angle_deg\n";
    int number = 0;
    const auto add = [&](const char* kind, double degrees, double compensation,
                         const std::string& name = "at") {
        const double angle = degrees * std::numbers::pi / 180;
        list += "thumb,0,0,100," + number_text(50 * std::cos(angle)) + "," +
                number_text(50 * std::sin(angle)) + ",100\n";
        trials += number_text(++number) + "," + kind + "," + name + " " +
                  number_text(static_cast<int>(degrees)) + ",z," + number_text(-compensation) +
                  "\n";
    };
    for (const double angle : {0.0, 45.0, 90.0}) add("baseline", angle, 1);
    add("visual_clamp", 45, 3);  // before training: counts as baseline, not as a probe
    for (int i = 0; i < 10; ++i) add("perturbed", 0, 3.0 * i);
    for (int i = 0; i < 2; ++i) {
        add("visual_clamp", 0, 21);
        add("visual_clamp", 45, 11);
        add("catch", 90, 3);
        add("visual_clamp", 0, 21, "straight");  // this condition has no baseline of its own
        add("catch", -45, 5);
    }
    const auto reaches = task::read_reaches(folder.write("trial-list.csv", list));
    const auto found =
        find_generalisation(rows::TrialFile(folder.write("trials.csv", trials)), reaches);
    ASSERT_EQ(found.size(), 5u);
    const double angles[] = {-45, 0, 0, 45, 90};
    const double all = (1 + 1 + 1 + 3) / 4.0;  // baseline for directions that lack one of their own
    const double trained = (20 + 21 - all) / 2;
    const double compensations[] = {5 - all, 20, 21 - all, 9, 2};
    const char* const baselines[] = {"all conditions", "its condition", "all conditions",
                                     "its condition", "its condition"};
    for (size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(found[i].trials, 2);
        EXPECT_NEAR(found[i].angle_deg, angles[i], 1e-4);
        EXPECT_NEAR(found[i].compensation_deg, compensations[i], 1e-6);
        EXPECT_NEAR(found[i].share, compensations[i] / trained, 1e-6);
        EXPECT_EQ(found[i].baseline, baselines[i]);
    }
    // probes only in the trained direction show no generalisation
    const std::string one =
        "trial_num,kind,condition,round,hand_angle_deg\n5,perturbed,a,z,-3\n"
        "6,visual_clamp,a,z,-3\n";
    EXPECT_TRUE(
        find_generalisation(rows::TrialFile(folder.write("one.csv", one)), reaches).empty());
}

TEST(Adaptation, IsNotSeenWhereNothingWasMeasuredOrPerturbed) {
    testing::TemporaryFolder folder;
    EXPECT_TRUE(
        adaptation_curves(rows::TrialFile(folder.write("a.csv", "trial_num,outcome\n1,done\n")))
            .empty());
    const auto curves = adaptation_curves(
        rows::TrialFile(folder.write("b.csv", trials_of(model::kSmith2006, 0, 0))));
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_FALSE(fit_adaptation(curves[0]));
}

TEST(Thresholds, AreFittedToTheAnswersOfTheirProcedure) {
    testing::TemporaryFolder folder;
    Random random(4, "observer");
    std::string text = "trial_num,share,procedure,outcome\n";
    const model::Psychometric observer{model::Sigmoid::normal, -0.5, 0.15, 0, 0};
    for (int i = 1; i <= 400; ++i) {
        const double level = random.uniform(-1, 0);
        const bool yes = random.uniform(0, 1) < observer.probability(level);
        text += number_text(i) + "," + number_text(std::pow(10, level)) + "," +
                (i % 10 == 0   ? ",none\n"
                 : i % 11 == 0 ? "a,late\n"
                 : yes         ? "a,felt\n"
                               : "a,not\n");
    }
    const auto tracks =
        threshold_tracks(rows::TrialFile(folder.write("trials.csv", text)),
                         rows::ProcedureFile(folder.write(
                             "procedures.csv",
                             "procedure,kind,perturbation,logarithmic,yes,no,sigmoid,guess,"
                             "guess_is_lapse\na,staircase,p,yes,felt,not,normal,0,no\n"
                             "b,quest,p,yes,felt,not,weibull_log10,0,no\n")));
    ASSERT_EQ(tracks.size(), 2u);
    EXPECT_GT(tracks[0].answers.size(), 300u);
    EXPECT_EQ(tracks[1].answers.size(), 0u);
    EXPECT_FALSE(fit_threshold(tracks[1]).fit);
    EXPECT_EQ(fit_threshold(tracks[1]).note, "not possible: 0 answers, but a fit requires 10");
    const ThresholdFit found = fit_threshold(tracks[0]);
    const auto& fitted = found.fit;
    ASSERT_TRUE(fitted);
    EXPECT_EQ(found.note, "");
    const auto intervals = threshold_intervals(tracks[0], *fitted);
    EXPECT_NEAR(fitted->function.threshold, -0.5, 0.05);
    EXPECT_LT(intervals.threshold.low, -0.5);
    EXPECT_GT(intervals.threshold.high, -0.5);
    EXPECT_NEAR(tracks[0].share(-0.5), 0.3162, 1e-4);
}

TEST(Thresholds, OfProceduresOverOneNumberArePooledAndHaveAWeberFraction) {
    const testing::TemporaryFolder folder;
    std::string text = "trial_num,mass_g,procedure,outcome\n";
    const char* levels[] = {"250", "230", "250", "220", "240", "210", "230", "200"};
    for (int i = 0; i < 8; ++i) {
        text += fmt::format("{},{},down,{}\n", 2 * i + 1, levels[i], i % 2 == 0 ? "yes" : "no");
        text += fmt::format("{},{},up,{}\n", 2 * i + 2, 200 + 10 * i, i > 3 ? "yes" : "no");
    }
    auto tracks = threshold_tracks(
        rows::TrialFile(folder.write("trials.csv", text)),
        rows::ProcedureFile(folder.write(
            "procedures.csv",
            "procedure,kind,perturbation,logarithmic,yes,no,sigmoid,guess,guess_is_lapse,level,"
            "standard\ndown,staircase,,no,yes,no,normal,0,no,mass_g,200\n"
            "up,staircase,,no,yes,no,normal,0,no,mass_g,200\n"
            "share,staircase,p,no,yes,no,normal,0,no,,\n")));
    ASSERT_EQ(tracks.size(), 4u);
    EXPECT_EQ(tracks[3].procedure, "down, up");
    EXPECT_EQ(tracks[3].answers.size(), 16u);
    EXPECT_EQ(tracks[3].trials[1], 2);
    EXPECT_EQ(tracks[3].answers[0].level, 250);
    // the last answer ends in a reversal, although no level follows
    EXPECT_EQ(tracks[0].reversals(), (std::vector<double>{230, 250, 220, 240, 210, 230, 200}));
    tracks[0].skipped_reversals = 4;
    EXPECT_EQ(tracks[0].reversals(), (std::vector<double>{210, 230, 200}));
    FigureLister row;
    list_psychophysics(tracks[0], {}, row);
    const auto figure = [&](const char* name) {
        const auto at = std::ranges::find(row.columns, name, &Table::Column::name);
        return std::get<double>(row.cells.at(static_cast<size_t>(at - row.columns.begin())));
    };
    EXPECT_EQ(figure("reversals"), 3);
    EXPECT_EQ(figure("mean_of_reversals"), 215);  // of as many peaks as valleys
    EXPECT_EQ(tracks[1].reversals(), std::vector<double>{240});
    // from the quartiles of a normal function, and from the threshold of a forced choice
    EXPECT_NEAR(tracks[3].weber_fraction({.threshold = 205, .shape = 20}), 0.0674490, 1e-6);
    EXPECT_NEAR(tracks[3].weber_fraction({.threshold = 225, .shape = 20, .guess = 0.5}), 0.125,
                1e-9);
    EXPECT_TRUE(std::isnan(tracks[2].weber_fraction({})));
}

TEST(Thresholds, ThatCannotBeFittedSayWhyAndOutsideOnesAreMarked) {
    ThresholdTrack track;
    track.model.sigmoid = model::Sigmoid::weibull;
    for (int i = 0; i < 20; ++i) track.answers.push_back({i % 5 * 0.1, i % 2 == 0});
    const ThresholdFit none = fit_threshold(track);  // because of a level of 0
    EXPECT_FALSE(none.fit);
    EXPECT_NE(none.note.find("Weibull"), std::string::npos) << none.note;
    // hardly any answer is "yes", so the threshold lies outside the levels shown
    track.model.sigmoid = model::Sigmoid::normal;
    track.model.guess = 0;
    track.answers.clear();
    for (int i = 0; i < 40; ++i) track.answers.push_back({i % 4 * 0.1, i % 4 == 3 && i % 8 == 3});
    for (int i = 0; i < 40; ++i) track.answers.push_back({i % 3 * 0.1, false});
    for (int i = 0; i < 10; ++i) track.answers.push_back({0.3, i == 0});
    const ThresholdFit far = fit_threshold(track);
    ASSERT_TRUE(far.fit);
    EXPECT_GT(far.fit->function.threshold, 0.3);
    EXPECT_NE(far.note.find("outside of the levels shown, 0 to 0.3"), std::string::npos)
        << far.note;
}

TEST(Thresholds, ThatFallOrDoNotDependOnTheLevelAreGuesses) {
    ThresholdTrack track;
    track.model.guess = 0;
    const auto answer = [&](double level, int yes, int no) {
        for (int i = 0; i < yes; ++i) track.answers.push_back({level, true});
        for (int i = 0; i < no; ++i) track.answers.push_back({level, false});
    };
    answer(50, 14, 1);
    answer(80, 9, 6);
    answer(110, 4, 11);
    answer(140, 0, 15);
    EXPECT_NE(fit_threshold(track).note.find("less likely as the level rises"), std::string::npos);
    track.answers.clear();
    for (const double level : {50, 80, 110, 140}) answer(level, 8, 7);
    EXPECT_NE(fit_threshold(track).note.find("as likely at all levels"), std::string::npos);
    track.answers.clear();
    answer(50, 1, 14);
    answer(80, 6, 9);
    answer(110, 11, 4);
    answer(140, 15, 0);
    EXPECT_EQ(fit_threshold(track).note, "");
}

TEST(Adaptation, WindowsAreOfOneBlockEach) {
    testing::TemporaryFolder folder;
    Learner learner;
    learner.add(10, "before", "baseline", 0);
    learner.add(2, "before", "visual_clamp", 0);  // inserted
    learner.add(60, "first", "perturbed", 30);
    learner.add(3, "first", "visual_clamp", 0);
    learner.add(20, "reversal", "perturbed", -30);
    learner.add(20, "clamp", "visual_clamp", 0);
    learner.add(12, "after", "washout", 0);
    const rows::TrialFile trials(folder.write("trials.csv", learner.trials(model::kSmith2006, 2)));
    const auto curve = adaptation_curves(trials).at(0);
    const auto mean = [&](size_t first, size_t count) {
        double sum = 0;
        for (size_t i = first; i < first + count; ++i) sum += curve.trials[i].compensation;
        return sum / static_cast<double>(count);
    };
    const auto at = curve.windows();
    EXPECT_NEAR(at.early.mean, mean(12, 8), 1e-9);
    EXPECT_NEAR(at.late.mean, mean(64, 8), 1e-9);         // excluding the trials of the reversal
    EXPECT_NEAR(at.clamp_first.mean, mean(95, 8), 1e-9);  // excluding the inserted clamps
    EXPECT_NEAR(at.clamp_last.mean, mean(107, 8), 1e-9);
    EXPECT_NEAR(at.washout_first.mean, mean(115, 8), 1e-9);
    EXPECT_EQ(at.early.trials, 8);
    EXPECT_LT(at.early.low, at.early.mean);
    EXPECT_GT(at.early.high, at.early.mean);
    const auto blocks = curve.blocks();
    ASSERT_EQ(blocks.size(), 5u);
    EXPECT_EQ(blocks[1].name, "first");
    EXPECT_NEAR(blocks[1].inserted_clamps.mean, mean(72, 3), 1e-9);
    EXPECT_NEAR(blocks[1].last.mean, mean(64, 8), 1e-9);
    EXPECT_EQ(blocks[3].inserted_clamps.trials, 0);
    EXPECT_EQ(block_table({curve}).rows.size(), 5u);
}

TEST(Perturbations, AreDescribedSoThatTheyDiffer) {
    testing::TemporaryFolder folder;
    const auto described = [&](const std::string& effect) {
        const task::Task task = read_frozen_task(
            folder.write("task.yaml", "perturbations:\n  - { name: one, " + effect + " }\n"));
        return std::get<std::string>(perturbation_table(task).rows.at(0)[2]);
    };
    const auto load = [&](const std::string& keys) {
        return described("field: { on: index, " + keys + " }");
    };
    EXPECT_EQ(load("kind: curl, damping_Ns_m: 13, axis: [0, 0, -1]"),
              "curl field of 13 N*s/m about (0, 0, -1), on index");
    const std::string channel = "kind: channel, stiffness_N_m: 1000, ";
    const std::string walls = "force channel of 1000 N/m to the ";
    EXPECT_EQ(load(channel + "about: start, normal: [0, 0, 1]"),
              walls + "plane across (0, 0, 1) through start, on index");
    EXPECT_EQ(load(channel + "from: start, to: target, free: [0, 0, 1]"),
              walls + "plane along (0, 0, 1) from start to target, on index");
    EXPECT_EQ(load(channel + "from: start, to: target"),
              walls + "line from start to target, on index");
    EXPECT_EQ(load("kind: spring, stiffness_N_m: 50, about: start, axis: [1, 0, 0], delay_ms: 20"),
              "spring of 50 N/m to the line along (1, 0, 0) through start, on index, 20 ms late");
    EXPECT_EQ(load("kind: spring, stiffness_N_m: 50, about: start"),
              "spring of 50 N/m to start, on index");
    EXPECT_EQ(described("loads: [{ kind: constant, on: [a, b], force_N: [0, 0, -1] }], "
                        "profile: { delay_ms: 50, rise_ms: 250, plateau_s: 1, fall_ms: 100 }"),
              "constant force (0, 0, -1) N, on a and b; after 50 ms; rising in 250 ms; "
              "full for 1000 ms; falling in 100 ms");
    EXPECT_EQ(described("body: { body: block, density_scale: 2, friction_scale: mass / 2 }"),
              "2 times the density; friction times (mass / 2)");
    EXPECT_EQ(described("visual: { moves: [proxies], about: a }"), "no effect");
}

TEST(Adaptation, ToAForceIsNotMeasuredAndSaysSo) {
    testing::TemporaryFolder folder;
    const task::Task task = read_frozen_task(folder.write(
        "task.yaml",
        "perturbations:\n"
        "  - { name: turn, visual: { moves: [proxies], about: a, angle_deg: 30 } }\n"
        "  - { name: curl, field: { kind: curl, on: finger, damping: 15 } }\n"
        "  - { name: rail, field: { kind: channel, on: finger } }\n"
        "  - name: push\n"
        "    loads: [{ kind: channel, on: finger }, { kind: constant, on: finger }]\n"
        "  - { name: heavy, body: { body: block, mass_scale: [2, 2, 2] } }\n"
        "rounds:\n"
        "  - perturbations: [{ name: side, body: { body: block, mass_scale: [3, 3, 1] } }]\n"));
    const Unmeasured unmeasured = unmeasured_perturbations(task);
    EXPECT_EQ(unmeasured, (Unmeasured{{"curl", "a force field (curl)"},
                                      {"push", "a force field (constant)"},
                                      {"rail", "a force channel"},
                                      {"side", "a mass that differs by direction"}}));
    std::string text =
        "trial_num,block,kind,round,perturbation,share,hand_angle_deg,shown_angle_deg\n";
    for (int i = 1; i <= 30; ++i) {
        const bool field = i > 10 && i <= 20;
        const bool rail = field && i % 5 == 0;
        text += number_text(i) + (field ? ",field," : ",flat,") +
                (rail     ? "error_clamp,,turn + rail,1,0,0\n"  // name used by earlier versions
                 : field  ? "perturbed,,curl,1,12,12\n"
                 : i > 20 ? "washout,,,0,-5,-5\n"
                          : "baseline,,,0,1,1\n");
    }
    const rows::TrialFile trials(folder.write("trials.csv", text));
    const auto curve = adaptation_curves(trials, unmeasured).at(0);
    EXPECT_EQ(curve.note(), "not measured under a force field (curl), a force channel");
    const auto at = curve.windows();
    EXPECT_TRUE(std::isnan(at.early.mean));
    EXPECT_TRUE(std::isnan(at.late.mean));
    EXPECT_TRUE(std::isnan(at.clamp_first.mean));
    EXPECT_NEAR(at.washout_first.mean, 5, 1e-9);  // this can be measured, whatever was learned
    EXPECT_NEAR(at.baseline.mean, -1, 1e-9);
    EXPECT_TRUE(std::isnan(curve.trials[12].perturbation));
    EXPECT_FALSE(fit_adaptation(curve));
    FigureLister landmarks;
    curve.list_landmarks(landmarks);
    const double perturbation = std::get<double>(landmarks.cells[2]);
    EXPECT_TRUE(std::isnan(perturbation));
    const task::Task none = read_frozen_task(folder.file("none.yaml"));
    EXPECT_TRUE(unmeasured_perturbations(none).empty());
    const Table all = perturbation_table(task);
    ASSERT_EQ(all.rows.size(), 6u);
    const auto what = [&](size_t i) { return std::get<std::string>(all.rows[i][2]); };
    EXPECT_EQ(what(0), "rotation by 30 deg about (0, 0, 0)");
    EXPECT_EQ(what(1), "curl field of 0 N*s/m, on finger");  // the file above gives no unit
    EXPECT_EQ(what(2), "force channel of 0 N/m, on finger");
    EXPECT_EQ(what(5), "inertia times (3, 3, 1)");
    EXPECT_TRUE(perturbation_table(none).rows.empty());
    EXPECT_EQ(curve.trials[14].kind, rows::TrialKind::force_channel);
    const rows::TrialFile earlier(folder.write("earlier.csv",
                                               "kind,perturbation\nerror_clamp,turn\n"
                                               "error_clamp,turn + rail\ncatch,rail\n"));
    EXPECT_EQ(kind_of(earlier[0].asked, unmeasured), rows::TrialKind::visual_clamp);
    EXPECT_EQ(kind_of(earlier[1].asked, unmeasured), rows::TrialKind::force_channel);
    EXPECT_EQ(kind_of(earlier[2].asked, unmeasured), rows::TrialKind::catch_trial);
    EXPECT_EQ(unmeasured_in("rail + turn + curl", unmeasured),
              "a force field (curl), a force channel");
    EXPECT_EQ(unmeasured_in("rails", unmeasured), "");
}

/// Returns trials.csv for a person who learns a force field, with a channel in every eighth trial.
std::string fields_of(const model::TwoRate& rates, double sign) {
    Learner learner;
    const auto add = [&](int count, const std::string& block, const std::string& kind, double f) {
        for (int i = 0; i < count; ++i)
            learner.add(1, block, i % 8 == 3 ? "force_channel" : kind, i % 8 == 3 ? 0 : f);
    };
    add(32, "before", "baseline", 0);
    add(240, "field", "perturbed", sign);
    add(32, "after", "washout", 0);
    for (auto& trial : learner.schedule) trial.clamp = false;
    for (size_t i = 0; i < learner.kinds.size(); ++i)
        learner.schedule[i].clamp = learner.kinds[i].kind == "force_channel";
    const auto x = model::compensation(rates, learner.schedule);
    std::string out =
        "trial_num,block,kind,round,perturbation,share,hand_angle_deg,shown_angle_deg,"
        "adaptation_index,field_share\n";
    for (size_t i = 0; i < x.size(); ++i) {
        const bool channel = learner.schedule[i].clamp;
        const double f = learner.schedule[i].perturbation;
        out += number_text(i + 1) + "," + learner.kinds[i].block + "," + learner.kinds[i].kind +
               ",," +
               (channel  ? "rail"
                : f != 0 ? "curl"
                         : "") +
               ",1,0,0," + (channel ? number_text(x[i] + 0.01) + "," : "," + number_text(f)) + "\n";
    }
    return out;
}

TEST(Adaptation, ToAFieldIsThatOfTheIndexInChannelsAndNeverAnAngle) {
    testing::TemporaryFolder folder;
    for (const double sign : {1.0, -1.0}) {
        const rows::TrialFile trials(
            folder.write("trials.csv", fields_of(model::kSmith2006, sign)));
        ASSERT_TRUE(has_adaptation_index(trials));
        const auto curves = adaptation_curves(trials);
        ASSERT_EQ(curves.size(), 1u);
        const AdaptationCurve& curve = curves[0];
        EXPECT_EQ(curve.measure, kAdaptationIndex);
        EXPECT_EQ(curve.note(), "");
        EXPECT_NEAR(curve.perturbation(), 100 * sign, 1e-9);
        EXPECT_TRUE(std::isnan(curve.trials[40].compensation));  // a trial without a channel
        EXPECT_FALSE(curve.trials[40].clamp);
        EXPECT_TRUE(curve.trials[35].clamp);
        const auto at = curve.windows();
        EXPECT_NEAR(at.baseline.mean, 1, 1e-6);
        EXPECT_EQ(at.baseline.trials, 4);
        EXPECT_EQ(at.late.trials, 8);
        EXPECT_GT(sign * at.late.mean, sign * at.early.mean + 10);
        EXPECT_EQ(at.washout_first.trials, 4);
        EXPECT_EQ(curve.blocks().at(1).last.trials, 8);
        const auto fits = fit_adaptation(curve);
        ASSERT_TRUE(fits);
        EXPECT_LT(fits->two_rate.residual_sd, 0.01);
        EXPECT_NEAR(fits->two_rate.rates.slow.retention, 0.992, 0.003);
        EXPECT_NEAR(fits->two_rate.rates.slow.learning, 0.02, 0.005);
    }
    // without the index, a channel shows no learning, whatever the kind of its trials
    const rows::TrialFile blind(folder.write(
        "blind.csv",
        "trial_num,block,kind,round,perturbation,share,hand_angle_deg,shown_angle_deg\n"
        "1,a,baseline,,,0,1,1\n2,a,force_channel,,rail,1,0,0\n"));
    const auto curve = adaptation_curves(blind).at(0);
    EXPECT_EQ(curve.note(), "not measured under a force channel");
    EXPECT_TRUE(std::isnan(curve.trials[1].compensation));
}

/// Returns trials.csv for carrying movements in two directions, in which the error shows what has
/// not been learned yet.
std::string errors_of(double effect, double noise) {
    Random random(5, "errors");
    std::vector<model::AdaptationTrial> schedule;
    for (int i = 0; i < 160; ++i) {
        const bool acts = i >= 30 && i < 120 && i % 10 != 9;  // includes catch trials
        schedule.push_back({acts ? 1.0 : 0.0, false});
    }
    const auto x = model::compensation(model::SingleRate{0.95, 0.15}, schedule);
    std::string out = "trial_num,block,kind,round,condition,perturbation,share,deviation_mm\n";
    for (size_t i = 0; i < schedule.size(); ++i) {
        const double p = schedule[i].perturbation;
        const std::string kind = i < 30     ? "baseline"
                                 : i >= 120 ? "washout"
                                 : p > 0    ? "perturbed"
                                            : "catch";
        for (const bool left : {true, false}) {
            const double error =
                3 + (left ? -1 : 0.5) * effect * (p - x[i]) + noise * random.normal();
            out += number_text(2 * i + (left ? 1 : 2)) + "," + kind + "," + kind + ",," +
                   (left ? "left" : "right") + "," + (p > 0 ? "heavy" : "") + ",1," +
                   number_text(error) + "\n";
        }
    }
    return out;
}

TEST(Adaptation, ToAMassIsThatOfTheErrorsInEachDirection) {
    testing::TemporaryFolder folder;
    const auto curves = error_curves(
        rows::TrialFile(folder.write("trials.csv", errors_of(12, 0.3))), "deviation_mm");
    ASSERT_EQ(curves.size(), 2u);
    EXPECT_EQ(curves[0].round, "left");
    EXPECT_EQ(curves[1].round, "right");
    for (const AdaptationCurve& curve : curves) {
        ASSERT_TRUE(curve.errors);
        const double effect = curve.round == "left" ? -12 : 6;
        EXPECT_NEAR(curve.errors->effect, effect, 0.6);
        EXPECT_NEAR(curve.errors->offset, 3, 0.3);
        EXPECT_EQ(curve.note(), "");
        EXPECT_NEAR(curve.perturbation(), 100, 1e-9);
        const auto at = curve.windows();
        EXPECT_NEAR(at.baseline.mean, 0, 3);
        EXPECT_NEAR(at.late.mean, 70,
                    7);  // 75 % = 15 / (15 + 5), minus the loss in catch trials
        EXPECT_GT(at.catch_trials.mean, 50);
        const auto fits = fit_adaptation(curve);
        ASSERT_TRUE(fits);
        EXPECT_NEAR(fits->single_rate.rate.retention, 0.95, 0.02);
        EXPECT_NEAR(fits->single_rate.rate.learning, 0.15, 0.04);
        EXPECT_LT(fits->single_rate.learning.low, 0.15);
        EXPECT_GT(fits->single_rate.learning.high, 0.15);
    }
    // an error that does not depend on the perturbation shows no learning, and a note says so
    const auto none =
        error_curves(rows::TrialFile(folder.write("none.csv", errors_of(0, 1))), "deviation_mm");
    for (const AdaptationCurve& curve : none) {
        EXPECT_FALSE(curve.errors);
        EXPECT_EQ(curve.note(),
                  "not measured under a perturbation that does not show in deviation_mm");
        EXPECT_FALSE(fit_adaptation(curve));
        EXPECT_TRUE(std::isnan(curve.windows().late.mean));
    }
}

TEST(Report, OfNothingSaysSo) {
    testing::TemporaryFolder folder;
    EXPECT_THROW(write_tables(folder.file("nothing"), {}), Error);
    folder.write("a.txt", "");
    EXPECT_THROW(write_tables(folder.file("."), {}), Error);
}

}  // namespace
}  // namespace dihaptic::analysis::report_test
