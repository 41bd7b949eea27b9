// Compares the eye positions computed from a tracker's samples with cases worked out by hand, and
// tests the messages when the stream appears and disappears.
#include "outlets/head_tracker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "base/temporary_folder.h"
#include "fake_lsl.h"

namespace dihaptic::outlets::head_tracker_test {
namespace {

constexpr double kRight = std::numbers::pi / 2;

TEST(HeadPose, IsThatOfTheSample) {
    TrackedHead head;
    head.position = {0, 0, 1};
    head.rotation = {0, 0, kRight};  // the tracker's x axis is the world's y axis
    head.eyes = {0, 0, -0.1};
    head.along = {2, 0, 0};
    head.unit = StreamUnit::mm;
    const float half = std::sqrt(0.5F);  // quarter turn about the tracker's z axis
    const std::array<float, 7> sample{100, 0, 500, half, 0, 0, half};
    const auto pose = head_pose(head, sample);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(pose->eyes.isApprox(Vec3(0, 0.1, 1.4), 1e-6)) << pose->eyes.transpose();
    EXPECT_TRUE(pose->along.isApprox(Vec3(-1, 0, 0), 1e-6)) << pose->along.transpose();
    EXPECT_TRUE(pose->seen);

    head.quaternion = StreamRotation::xyzw;
    const auto same = head_pose(head, std::array<float, 7>{100, 0, 500, 0, 0, half, half});
    ASSERT_TRUE(same);
    EXPECT_TRUE(same->eyes.isApprox(pose->eyes, 1e-6));
    EXPECT_TRUE(same->along.isApprox(pose->along, 1e-6));

    head.quaternion = StreamRotation::none;
    const auto turned = head_pose(head, std::array<float, 3>{100, 0, 500});
    ASSERT_TRUE(turned);
    EXPECT_TRUE(turned->along.isApprox(Vec3(0, 1, 0), 1e-6)) << turned->along.transpose();
}

TEST(HeadPose, IsNoneOfABodyThatIsNotSeen) {
    const TrackedHead head;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(head_pose(head, std::array<float, 7>{0, nan, 0, 1, 0, 0, 0}));
    EXPECT_FALSE(head_pose(head, std::array<float, 7>{0, 0, 0, 0, 0, 0, 0}));
    EXPECT_TRUE(head_pose(head, std::array<float, 7>{0, 0, 0, 1, 0, 0, 0}));
}

/// Provides a tracker's stream in the fake liblsl.
class Stream : public ::testing::Test {
  protected:
    Stream() {
        setenv("DIHAPTIC_FAKE_LSL_IN", file().c_str(), 1);
        head.stream = "Head";
        head.library = DIHAPTIC_FAKE_LSL;
        head.first = 2;
        head.quaternion = StreamRotation::none;
        head.place = {"rig.yaml", 9};
    }
    ~Stream() override { unsetenv("DIHAPTIC_FAKE_LSL_IN"); }

    std::string file() const { return folder_.path() + "/stream"; }
    void send(const std::string& sample, const std::string& about = "Head 5") const {
        std::ofstream(file() + ".new") << about << "\n" << sample << "\n";
        std::filesystem::rename(file() + ".new", file());  // so that half a file is never read
    }
    /// Waits for a condition; returns whether it became true in time.
    static bool comes(const std::function<bool()>& holds) {
        for (int i = 0; i < 1000; ++i) {
            if (holds()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    static bool tells(HeadTracker& tracker, const std::string& what) {
        return comes([&] {
            for (const HeadTracker::Told& told : tracker.take_told()) {
                if (told.what.find(what) != std::string::npos) return true;
            }
            return false;
        });
    }

    TrackedHead head;

  private:
    TemporaryFolder folder_;
};

TEST_F(Stream, IsWaitedForFollowedAndWaitedForAgain) {
    HeadTracker tracker(head);
    EXPECT_TRUE(tells(tracker, "no stream 'Head'"));
    EXPECT_FALSE(tracker.newest());
    send("9 9 0.1 0.2 0.3");
    EXPECT_TRUE(tells(tracker, "tracked by the stream 'Head'"));
    EXPECT_TRUE(comes([&] { return tracker.newest().has_value(); }));
    EXPECT_TRUE(tracker.newest()->eyes.isApprox(Vec3(0.1, 0.2, 0.3), 1e-6));
    send("9 9 0.4 0.2 0.3");
    EXPECT_TRUE(comes([&] { return std::abs(tracker.newest()->eyes.x() - 0.4) < 1e-6; }));

    send("9 9 nan nan nan");
    EXPECT_TRUE(tells(tracker, "does not see the head"));
    EXPECT_TRUE(comes([&] { return !tracker.newest()->seen; }));
    EXPECT_NEAR(tracker.newest()->eyes.x(), 0.4, 1e-6);  // last known position
    send("9 9 0.5 0.2 0.3");
    EXPECT_TRUE(tells(tracker, "sees the head again"));
    send("silent");
    EXPECT_TRUE(tells(tracker, "does not see the head"));

    send("lost");
    EXPECT_TRUE(tells(tracker, "the stream was lost"));
    send("9 9 0.6 0.2 0.3");
    EXPECT_TRUE(comes([&] { return std::abs(tracker.newest()->eyes.x() - 0.6) < 1e-6; }));
    EXPECT_TRUE(tracker.newest()->seen);
}

TEST_F(Stream, WithTooFewChannelsIsRefused) {
    send("1 2 3 4", "Head 4");
    HeadTracker tracker(head);
    EXPECT_TRUE(tells(tracker, "rig.yaml:9: error: first: the stream 'Head' has 4 channels"));
}

TEST_F(Stream, IsNoneWithoutTheLibrary) {
    head.library = "/no/such/liblsl.so";
    HeadTracker tracker(head);
    EXPECT_TRUE(tells(tracker, "/no/such/liblsl.so"));
    EXPECT_FALSE(tracker.newest());
}

}  // namespace
}  // namespace dihaptic::outlets::head_tracker_test
