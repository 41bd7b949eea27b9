// A session in a BIDS data set, against the names and columns of the specification.
#include "analysis/bids.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "recording/codec.h"
#include "recording/raw_log.h"
#include "testing/files.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;

/// A session of three ticks with one finger.
recording::SessionFolder session(const std::string& parent, const std::string& state) {
    const auto folder = recording::SessionFolder::create(parent, "reach");
    recording::LogHead head;
    head.tick = 1e-3;
    head.fingers = {"index"};
    head.title = "Reaches";
    head.experiment = "experiments/visuomotor-rotation.yaml";
    head.seed = "1";
    {
        recording::RawLogWriter log(folder.raw_log(), head);
        for (int i = 0; i < 3; ++i) {
            servo::Frame frame;
            frame.sequence = i;
            frame.time = i * std::chrono::milliseconds(1);
            frame.fingers.resize(1);
            frame.fingers[0].p_WH = {0.001 * i, 0.5, -0.25};
            frame.fingers[0].f_sent_W = {0, 0, 2};
            std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 0));
            log.add(std::span(bytes).first(recording::encode(frame, bytes)));
        }
        log.finish();
    }
    recording::SessionInfo info;
    static_cast<recording::Setup&>(info) = head;
    info.participant = {"S 07", "25", "F", "right"};
    info.program = "dihaptic";
    info.started = "2026-11-20T10:15:00+01:00";
    info.state =
        state == "running" ? recording::SessionState::running : recording::SessionState::complete;
    folder.write_info(info);
    std::ofstream(folder.file("events.csv"))
        << "time_s,trial,event,detail\n0.001,1,touch,\"index\tblock\"\n";
    return folder;
}

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

TEST(Bids, HasTheFilesAndColumnsThatTheSpecificationAsksFor) {
    testing::TemporaryFolder folder;
    const std::string set = folder.file("study");
    const std::string motion = export_bids(session(folder.file("a"), "complete"), set, {}).folder;
    EXPECT_EQ(motion, set + "/sub-S07/motion");
    const std::string stem = motion + "/sub-S07_task-visuomotorrotation_tracksys-index_run-01_";
    const auto rows = lines(testing::read_file(stem + "motion.tsv"));
    ASSERT_EQ(rows.size(), 3u);  // and no header
    EXPECT_TRUE(rows[1].starts_with("0.001\t0.5\t-0.25\t")) << rows[1];
    EXPECT_TRUE(rows[1].ends_with("\t0.001")) << rows[1];
    const auto channels = lines(testing::read_file(stem + "channels.tsv"));
    const auto columns = [](const std::string& line) {
        return std::count(line.begin(), line.end(), '\t') + 1;
    };
    EXPECT_TRUE(channels[0].starts_with("name\tcomponent\ttype\ttracked_point\tunits"));
    EXPECT_EQ(static_cast<long>(channels.size()) - 1, columns(rows[0]));
    const auto json = nlohmann::json::parse(testing::read_file(stem + "motion.json"));
    EXPECT_EQ(json["SamplingFrequency"], 1000);
    EXPECT_EQ(json["TaskName"], "visuomotorrotation");
    EXPECT_EQ(json["MISCChannelCount"], 6);
    EXPECT_EQ(json["MotionChannelCount"], columns(rows[0]));
    const auto events =
        lines(testing::read_file(motion + "/sub-S07_task-visuomotorrotation_run-01_events.tsv"));
    EXPECT_EQ(events[1], "0.001\tn/a\ttouch\t1\tindex block");
    EXPECT_EQ(lines(testing::read_file(set + "/participants.tsv"))[1], "sub-S07\t25\tF\tright");
    EXPECT_TRUE(fs::exists(set + "/dataset_description.json"));
}

TEST(Bids, ASecondSessionIsAnotherRunAndReplacesNothing) {
    testing::TemporaryFolder folder;
    const std::string set = folder.file("study");
    export_bids(session(folder.file("a"), "complete"), set, {});
    const std::string motion = export_bids(session(folder.file("b"), "complete"), set, {}).folder;
    for (const char* run : {"01", "02"})
        EXPECT_TRUE(fs::exists(motion + "/sub-S07_task-visuomotorrotation_tracksys-index_run-" +
                               run + "_motion.tsv"));
    EXPECT_EQ(lines(testing::read_file(set + "/participants.tsv")).size(), 2u);
    EXPECT_EQ(lines(testing::read_file(set + "/sub-S07/sub-S07_scans.tsv")).size(), 3u);
}

TEST(Bids, ASessionThatRunsIsNotExported) {
    testing::TemporaryFolder folder;
    EXPECT_THROW(export_bids(session(folder.file("a"), "running"), folder.file("s"), {}), Error);
}

}  // namespace
}  // namespace dihaptic::analysis
