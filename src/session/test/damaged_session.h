// Passes sessions with damaged files to every function that reads them: faults must be reported, or
// refused with an Error, and nothing else may be thrown.
#pragma once

#include <gtest/gtest.h>

#include "analysis/bids.h"
#include "analysis/recovery.h"
#include "analysis/report/report.h"
#include "base/number.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "testing/log_chunks.h"

namespace dihaptic::session {

namespace fs = std::filesystem;

/// Two short sessions without the files that are made from their logs, and the contents of their
/// files.
class TwoSessions {
  public:
    TwoSessions() {
        for (const char* seed : {"0.2", "0.3"}) {
            Request request;
            request.file = folder_.write(std::string("short") + seed + ".yaml",
                                         std::string("bodies:\n"
                                                     "  - { name: floor, shape: plane, fixed: yes "
                                                     "}\nhand: { centre_mm: [0, 0, 100], script: "
                                                     "[{ name: wait, duration_s: ") +
                                             seed + " }, { name: rest, duration_s: 0.2 }] }\n");
            RunOptions options;
            options.out = folder_.file("sessions");
            const RunResult result = run_session(make_plan(request), options, kGoOn, {});
            sessions_.push_back(result.folder);
            logs_.push_back(testing::read_file(result.folder + "/raw.log"));
        }
    }

    const std::string& log() const { return logs_[0]; }
    const std::string& other() const { return logs_[1]; }
    std::string file(const std::string& name) const { return folder_.file(name); }

    /// Returns a copy of the first session with the given log. `known` is whether session.yaml says
    /// how many ticks it had.
    recording::SessionFolder copy(const std::string& log, bool known) const {
        const std::string path = folder_.file("copy");
        fs::remove_all(path);
        fs::copy(sessions_[0], path);
        std::ofstream(path + "/raw.log", std::ios::binary) << log;
        const auto session = recording::SessionFolder::open(path);
        if (!known) {
            recording::SessionInfo info = session.read_info();
            info.ticks = 0;
            session.write_info(info);
        }
        return session;
    }

  private:
    testing::TemporaryFolder folder_;
    std::vector<std::string> sessions_;
    std::vector<std::string> logs_;
};

/// Damages logs in each way `cases` times. Checks that recovery never calls the log complete, that
/// a replay never passes, and that report and export say what is wrong.
inline void expect_all_tell(int cases) {
    const TwoSessions sessions;
    {
        const auto whole = sessions.copy(sessions.log(), false);
        ASSERT_FALSE(analysis::recover_session(whole, {}).figures.log.damaged(0));
        ASSERT_TRUE(replay_session(whole.path(), kGoOn, {}).good());
    }
    for (int what = 0; what < testing::kMischiefs; ++what) {
        for (int seed = 0; seed < cases; ++seed) {
            SCOPED_TRACE(std::string(testing::kMischiefNames[what]) + " " + number_text(seed));
            std::mt19937_64 random(static_cast<uint64_t>(seed));
            const std::string log = testing::do_mischief(static_cast<testing::Mischief>(what),
                                                         sessions.log(), sessions.other(), random);
            const auto session = sessions.copy(log, seed % 2 == 0);
            EXPECT_FALSE(replay_session(session.path(), kGoOn, {}).good());
            const analysis::Recovery recovery = analysis::recover_session(session, {});
            EXPECT_TRUE(recovery.figures.log.damaged(recovery.info.ticks));
            EXPECT_EQ(session.read_info().state, recording::SessionState::recovered);
            EXPECT_FALSE(session.read_info().notes.empty());
            // a recovered session needs no end mark, so a log that contains all records can be
            // replayed
            const recording::LogHealth& left = recovery.figures.log;
            if (left.complete || !left.gaps.empty() || !left.strays.empty()) {
                EXPECT_FALSE(replay_session(session.path(), kGoOn, {}).good());
            }
            if (seed % 5 == 0) {
                fs::remove_all(sessions.file("study"));  // a data set has each session only once
                EXPECT_FALSE(analysis::write_tables(session.path(), {}).log.empty());
                EXPECT_FALSE(
                    analysis::export_bids(session, sessions.file("study"), {}).log.empty());
            }
            if (::testing::Test::HasFailure()) return;
        }
    }
}

/// Calls every function that reads a session. An Error is accepted; any other exception is a
/// failure.
inline void read_all_ways(const std::string& path, const std::string& study) {
    const auto attempt = [](const char* what, const std::function<void()>& read) {
        try {
            read();
        } catch (const Error& e) {
            EXPECT_FALSE(e.problems().empty());
        } catch (const std::exception& e) {
            ADD_FAILURE() << what << ": " << e.what();
        }
    };
    attempt("replay", [&] { replay_session(path, kGoOn, {}); });
    attempt("report", [&] { analysis::write_tables(path, {}); });
    attempt("export",
            [&] { analysis::export_bids(recording::SessionFolder::open(path), study, {}); });
    attempt("resume", [&] {
        recording::SessionInfo info;
        make_rest(path, Seat::terminal, info);
    });
    attempt("recover",
            [&] { analysis::recover_session(recording::SessionFolder::open(path), {}); });
}

/// Damages the files of a session with trials at random, one after another.
inline void expect_mutated_files_are_borne(int cases, uint64_t first_seed) {
    Files files;
    const RunResult result = files.run(make_plan(files.request()));
    const auto made = recording::SessionFolder::open(result.folder);
    analysis::finish_session(made, result.info, {});
    const std::string copy = files.folder.file("copy");
    const std::vector<std::string> names = {"session.yaml", "trials.csv", "trial-list.csv",
                                            "task.yaml",    "events.csv", "settings.yaml",
                                            "scene.yaml",   "rig.yaml",   "lifts.csv",
                                            "settings.csv", "raw.log"};
    for (int i = 0; i < cases; ++i) {
        const std::string& name = names[static_cast<size_t>(i) % names.size()];
        SCOPED_TRACE(name + " " + number_text(i));
        std::mt19937_64 random(first_seed + static_cast<uint64_t>(i));
        fs::remove_all(copy);
        fs::remove_all(files.folder.file("study"));
        fs::copy(result.folder, copy);
        std::string text =
            fs::exists(copy + "/" + name) ? testing::read_file(copy + "/" + name) : "a,b\n1,2\n";
        if (name == "raw.log") {
            // a part of the log is enough and faster; files made from more of the log would be kept
            auto chunks = testing::take_apart(text);
            chunks.erase(chunks.begin() + 12, chunks.end() - 1);
            text = testing::crafted(testing::put_together(chunks), random);
            for (const char* longer : {"session.nwb", "trials.csv", "phases.csv", "events.csv"})
                fs::remove(copy + "/" + longer);
        } else {
            text = testing::damaged(text, "a: [1, 2]\n...\n", random);
        }
        std::ofstream(copy + "/" + name, std::ios::binary) << text;
        const std::string checked = i % 2 == 0 ? name : "";
        if (!checked.empty() && name != "raw.log" && name != "session.yaml") {
            // gives the changed file a matching checksum, as if it had not been changed
            auto info = recording::SessionFolder::open(result.folder).read_info();
            for (recording::InputFile& input : info.inputs) {
                if (input.file == name) input = recording::SessionFolder::open(copy).input(name);
            }
            recording::SessionFolder::open(copy).write_info(info);
        }
        read_all_ways(copy, files.folder.file("study"));
        if (::testing::Test::HasFailure()) return;
    }
}

}  // namespace dihaptic::session
