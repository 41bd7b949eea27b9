// Tests the export of a session to a BIDS data set against the names and columns in the
// specification.
#include "analysis/bids.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "recording/codec.h"
#include "recording/raw_log.h"
#include "testing/files.h"

namespace dihaptic::analysis::bids_test {
namespace {

namespace fs = std::filesystem;

/// Makes a session of three ticks with one finger.
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
            frame::Frame frame;
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
    info.moved_by.mover = recording::Mover::devices;
    info.program = "dihaptic";
    info.started = "2026-11-20T10:15:00+01:00";
    info.state =
        state == "running" ? recording::SessionState::running : recording::SessionState::complete;
    folder.write_info(info);
    std::ofstream(folder.file("events.csv"))
        << "time_s,trial,event,detail\n0,1,trial,attempt 1\n0.001,1,touch,\"index\tblock\"\n"
           "0.002,0,phase,\n";
    std::ofstream(folder.file("trials.csv"))
        << "start_time,stop_time,session_num,trial_num,block,condition,attempt,outcome,"
           "hand_angle_deg\n0,0.5,1,1,old,none,1,reached,3\n"
           "0,0.001,2,1,turned,\"far, left\",1,reached,12.5\n";
    std::ofstream(folder.file("trials-before.csv"))
        << "start_time,stop_time,session_num,trial_num,block,condition,attempt,outcome,"
           "hand_angle_deg\n0,0.5,1,1,old,none,1,reached,3\n";
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
    ASSERT_EQ(rows.size(), 3u);  // motion.tsv has no header
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
    EXPECT_EQ(json["TaskName"], "visuomotor-rotation");
    EXPECT_EQ(json["MISCChannelCount"], 6);
    EXPECT_EQ(json["MotionChannelCount"], columns(rows[0]));
    const auto events =
        lines(testing::read_file(motion + "/sub-S07_task-visuomotorrotation_run-01_events.tsv"));
    // only this session's trials, with their demands and measures; events have only the demands
    ASSERT_EQ(events.size(), 4u);
    EXPECT_EQ(events[0],
              "onset\tduration\ttrial_type\tvalue\ttrial_num\tattempt\tblock\tcondition\toutcome"
              "\thand_angle_deg\tsimulated\tmoved_by\tHED");
    EXPECT_EQ(events[1],
              "0\t0.001\ttrial\treached\t1\t1\tturned\tfar, "
              "left\treached\t12.5\tno\tdevices\tLabel/2-trial-1");
    EXPECT_EQ(events[2],
              "0.001\tn/a\ttouch\tindex block\t1\t1\tturned\tfar, "
              "left\tn/a\tn/a\tno\tdevices\tLabel/2-index-block");
    EXPECT_EQ(events[3],
              "0.002\tn/a\tphase\tn/a\t0\tn/a\tn/a\tn/a\tn/a\tn/a\tno\tdevices\tLabel/3");
    EXPECT_EQ(lines(testing::read_file(set + "/participants.tsv"))[1],
              "sub-S07\t25\tF\tright\tS 07\tno\tdevices");
    const auto set_json =
        nlohmann::json::parse(testing::read_file(set + "/dataset_description.json"));
    EXPECT_EQ(set_json["Simulated"], false);
    EXPECT_EQ(testing::read_file(set + "/README").find("SIMULATION"), std::string::npos);
    EXPECT_TRUE(fs::exists(set + "/dataset_description.json"));
}

TEST(Bids, ASecondSessionIsAnotherRunAndReplacesNothing) {
    testing::TemporaryFolder folder;
    const std::string set = folder.file("study");
    export_bids(session(folder.file("a"), "complete"), set, {});
    const std::string motion = export_bids(session(folder.file("a"), "complete"), set, {}).folder;
    for (const char* run : {"01", "02"})
        EXPECT_TRUE(fs::exists(motion + "/sub-S07_task-visuomotorrotation_tracksys-index_run-" +
                               run + "_motion.tsv"));
    EXPECT_EQ(lines(testing::read_file(set + "/participants.tsv")).size(), 2u);
    EXPECT_EQ(lines(testing::read_file(set + "/sub-S07/sub-S07_scans.tsv")).size(), 3u);
}

TEST(Bids, ASimulationIsNotAddedToPersons) {
    testing::TemporaryFolder folder;
    const std::string set = folder.file("study");
    export_bids(session(folder.file("a"), "complete"), set, {});
    for (const auto mover : {recording::Mover::simulated_person, recording::Mover::script}) {
        const auto other = session(folder.file("b"), "complete");
        recording::SessionInfo info = other.read_info();
        info.moved_by.mover = mover;
        other.write_info(info);
        EXPECT_THROW(export_bids(other, set, {}), Error);
    }
}

TEST(Bids, AnotherWithTheSameLabelIsNotAdded) {
    testing::TemporaryFolder folder;
    const std::string set = folder.file("study");
    export_bids(session(folder.file("a"), "complete"), set, {});
    const auto other = session(folder.file("b"), "complete");
    recording::SessionInfo info = other.read_info();
    info.participant.id = "S07";
    other.write_info(info);
    try {
        export_bids(other, set, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find(
                      "is participant S 07 in the data set, but S07 in this session"),
                  std::string::npos)
            << e.what();
    }
}

TEST(Bids, ASessionThatRunsIsNotExported) {
    testing::TemporaryFolder folder;
    EXPECT_THROW(export_bids(session(folder.file("a"), "running"), folder.file("s"), {}), Error);
}

}  // namespace
}  // namespace dihaptic::analysis::bids_test
