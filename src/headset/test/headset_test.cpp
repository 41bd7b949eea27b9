// Tests headsets on the tests' own OpenXR runtime, with OpenXR's validation layer in between, which
// must report nothing. The display is provided by Xvfb, because pictures are drawn with OpenGL on
// X11.
#include "headset/headset.h"
#include "base/number.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <sstream>

#include "base/diagnostics.h"
#include "base/random.h"
#include "headset/xr.h"
#include "runtime.h"
#include "test_runtime_files.h"
#include "testing/files.h"
#include "view/offscreen.h"
#include "view/scene_view.h"
#include "view/test/drawn_points.h"

namespace dihaptic::headset::headset_test {
namespace {

using test::Handed;
using test::Pretence;
using test::RuntimeEye;
using test::RuntimePose;

/// An X11 display that is not shown on any screen.
class Xvfb {
  public:
    Xvfb() {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) throw Error("there is no pipe", "");
        child_ = fork();
        if (child_ == 0) {
            const std::string number = number_text(ends[1]);
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "640x480x24",
                   "-nolisten", "tcp", nullptr);
            _exit(127);
        }
        close(ends[1]);
        std::string number;
        char digit = 0;
        while (read(ends[0], &digit, 1) == 1 && digit != '\n') number += digit;
        close(ends[0]);
        starts_ = !number.empty();
        if (starts_) setenv("DISPLAY", (":" + number).c_str(), 1);
    }
    bool starts() const { return starts_; }
    ~Xvfb() {
        kill(child_, SIGTERM);
        waitpid(child_, nullptr, 0);
    }
    Xvfb(const Xvfb&) = delete;
    Xvfb& operator=(const Xvfb&) = delete;

  private:
    pid_t child_ = 0;
    bool starts_ = false;
};

class HeadsetTest : public ::testing::Test {
  protected:
    HeadsetTest() {
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("XR_RUNTIME_JSON", DIHAPTIC_TEST_RUNTIME_MANIFEST, 1);
        setenv("XR_ENABLE_API_LAYERS", "XR_APILAYER_LUNARG_core_validation", 1);
        setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
        setenv("XR_CORE_VALIDATION_FILE_NAME", messages_.c_str(), 1);
        library_ = dlopen(DIHAPTIC_TEST_RUNTIME, RTLD_NOW);
        EXPECT_NE(library_, nullptr) << dlerror();
        pretend_ = reinterpret_cast<test::PretendFunction>(dlsym(library_, test::kPretend));
        wait_ = reinterpret_cast<test::WaitFunction>(dlsym(library_, test::kWaitForPicture));
    }
    ~HeadsetTest() override { dlclose(library_); }
    void SetUp() override {
        if (!xvfb_.starts())
            GTEST_SKIP() << "Xvfb does not start; it is in the Debian package xvfb";
    }

    /// The messages from the validation layer. Newer versions of the layer also report that they
    /// begin and end.
    std::string messages() const {
        std::istringstream all(testing::read_file(messages_));
        std::string out;
        for (std::string line; std::getline(all, line);)
            if (line.find("VALID_DEBUG") == std::string::npos) out += line + "\n";
        return out;
    }

    void pretend(const Pretence& pretence) { pretend_(pretence); }
    Handed next_picture() {
        Handed out;
        EXPECT_TRUE(wait_(out)) << "no picture came";
        return out;
    }
    static std::vector<Note> notes_at_the_end(Headset& headset) {
        for (int i = 0; i < 6000 && !headset.ended(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_TRUE(headset.ended());
        return headset.take_notes();
    }

  private:
    testing::TemporaryFolder folder_;
    std::string messages_ = folder_.file("messages.txt");
    Xvfb xvfb_;
    void* library_ = nullptr;
    test::PretendFunction pretend_ = nullptr;
    test::WaitFunction wait_ = nullptr;
};

Image image_of(const test::RuntimePicture& picture) {
    Image out{picture.width, picture.height, {}};
    for (int y = picture.height - 1; y >= 0; --y) {
        for (int x = 0; x < picture.width; ++x) {
            const auto at = 4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) +
                                 static_cast<size_t>(x));
            out.rgb.insert(out.rgb.end(), &picture.rgba[at], &picture.rgba[at] + 3);
        }
    }
    return out;
}

RuntimePose to_runtime(const Pose& X) {
    const XrPosef out = xr::to_xr(X);
    return {{out.position.x, out.position.y, out.position.z},
            {out.orientation.x, out.orientation.y, out.orientation.z, out.orientation.w}};
}

/// The pose of a person's head that is in one place and looks at another.
Pose head_at(const Vec3& at, const Vec3& looked_at) {
    const Vec3 backward = (at - looked_at).normalized();
    const Vec3 right = Vec3::UnitZ().cross(backward).normalized();
    Mat3 R;
    R << right, backward.cross(right), backward;
    return {Quat(R), at};
}

/// A head somewhere in front of the table, with eyes that look slightly outwards, as in wide
/// headsets.
struct Seen {
    Pretence pretence;
    std::array<Pose, 2> X_WE;
    Pose X_WV;
};
Seen random_head(Random& random, const Pose& X_WS) {
    const auto vector = [&](double most) {
        return Vec3(random.uniform(-most, most), random.uniform(-most, most),
                    random.uniform(-most, most));
    };
    Seen out;
    out.X_WV = head_at(Vec3(0, -0.35, 0.35) + vector(0.1), vector(0.05));
    out.X_WV.R = rotation_by(vector(0.3)) * out.X_WV.R;
    out.pretence.head = to_runtime(X_WS.inverse() * out.X_WV);
    for (size_t eye = 0; eye < 2; ++eye) {
        const double side = eye == 0 ? -1 : 1;
        const Pose X_VE{rotation_by({0, -side * random.uniform(0, 0.15), 0}),
                        Vec3(side * random.uniform(0.027, 0.036), 0, 0)};
        out.X_WE[eye] = out.X_WV * X_VE;
        RuntimeEye& told = out.pretence.eyes[eye];
        told.pose = to_runtime(X_WS.inverse() * out.X_WE[eye]);
        told.left = static_cast<float>(-random.uniform(0.6, 0.85));
        told.right = static_cast<float>(random.uniform(0.6, 0.85));
        told.up = static_cast<float>(random.uniform(0.6, 0.85));
        told.down = static_cast<float>(-random.uniform(0.6, 0.85));
    }
    return out;
}

/// The position at which a pinhole camera at an eye sees a point, in pixels from the upper left
/// corner of the picture.
Eigen::Vector2d pinhole(const RuntimeEye& eye, const Pose& X_WE, const Vec3& p_W, int width,
                        int height) {
    const Vec3 p_E = X_WE.inverse() * p_W;
    const double x = p_E.x() / -p_E.z(), y = p_E.y() / -p_E.z();
    const double left = std::tan(eye.left), right = std::tan(eye.right);
    const double up = std::tan(eye.up), down = std::tan(eye.down);
    return {(x - left) / (right - left) * width, (up - y) / (up - down) * height};
}

/// A head at the origin of its space, looking ahead.
Pretence looks_ahead() {
    Pretence out;
    for (RuntimeEye& eye : out.eyes) eye = {{}, -0.7f, 0.7f, 0.7f, -0.7f};
    return out;
}

std::vector<Showing> next_showings(Headset& headset) {
    std::vector<Showing> out;
    while (out.empty()) out = headset.take_showings();
    return out;
}

/// Frames whose newest frame never changes.
std::shared_ptr<Headset::Frames> still(const frame::Frame& frame) {
    return std::make_shared<Headset::Frames>(frame);
}

display::Headset somewhere() {
    display::Headset out;
    out.position = {0.1, -0.7, -0.9};
    out.rotation = {0.02, -0.03, 0.4};
    return out;
}

TEST_F(HeadsetTest, DrawsPointsWhereAPinholeWouldForEachEye) {
    const display::Headset place = somewhere();
    Random random(11, "headset");
    view::Balls balls;
    for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y)
            balls.add(Vec3(0.075 * x, 0.075 * y, random.uniform(-0.03, 0.03)), 0.004);
    }
    Headset headset(place);
    int points = 0;
    double worst = 0;
    for (int i = 0; i < 36; ++i) {
        const Seen seen = random_head(random, place.X_WS());
        headset.show(balls.scene, still(balls.away()));
        pretend(seen.pretence);
        const Handed without = next_picture();
        headset.show(balls.scene, still(balls.frame));
        pretend(seen.pretence);
        const Handed with = next_picture();
        for (size_t eye = 0; eye < 2; ++eye) {
            const Image empty = image_of(without.eyes[eye]), picture = image_of(with.eyes[eye]);
            const auto exact = [&](const scene::Body& ball) {
                return pinhole(seen.pretence.eyes[eye], seen.X_WE[eye], ball.position,
                               picture.width, picture.height);
            };
            for (const scene::Body& ball : balls.scene.bodies) {
                const Eigen::Vector2d at = exact(ball);
                const bool inside = (at.array() > 20).all() && at.x() < picture.width - 20 &&
                                    at.y() < picture.height - 20;
                const bool is_apart = std::all_of(
                    balls.scene.bodies.begin(), balls.scene.bodies.end(), [&](const auto& other) {
                        return &other == &ball || (exact(other) - at).norm() > 30;
                    });
                if (!inside || !is_apart) continue;
                const double off = (view::middle_of(picture, empty, 0, at) - at).norm();
                EXPECT_LT(off, 0.5) << ball.name << ", eye " << eye << ", head " << i;
                worst = std::max(worst, off);
                ++points;
            }
        }
    }
    EXPECT_GT(points, 1000);
    RecordProperty("worst_px", number_text(worst));
    RecordProperty("points", points);
    std::printf("%d points, %.3f pixels off at worst\n", points, worst);
    EXPECT_EQ(messages(), "");
}

TEST_F(HeadsetTest, IsHeldAgainstAValidationLayerThatTellsOfMistakes) {
    {
        xr::Instance instance;
        auto info = xr::made<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
        std::strcpy(info.applicationInfo.applicationName, "mistaken");
        info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
        ASSERT_EQ(xrCreateInstance(&info, instance.out()), XR_SUCCESS);
        const auto wrong = xr::made<XrSystemGetInfo>(XR_TYPE_SESSION_BEGIN_INFO);
        XrSystemId system = 0;
        EXPECT_NE(xrGetSystem(instance, &wrong, &system), XR_SUCCESS);
    }
    EXPECT_NE(messages(), "");
}

/// A scene with a table, a block on it, and no fingers.
scene::Scene block_scene() {
    view::Balls out;
    out.add({0, 0, 0.02}, 0.02);
    out.scene.bodies[0].colour = "#3070c0";
    return out.scene;
}

frame::Frame frame_of(const scene::Scene& scene, int64_t tick) {
    frame::Frame out;
    for (const scene::Body& body : scene.bodies) out.bodies.push_back({body.pose()});
    out.sequence = tick;
    return out;
}

TEST_F(HeadsetTest, HasTheColoursThatAScreenHas) {
    const display::Headset place;
    Random random(3, "headset");
    const Seen seen = random_head(random, place.X_WS());
    pretend(seen.pretence);
    const scene::Scene scene = block_scene();
    const frame::Frame frame = frame_of(scene, -1);
    Handed handed;
    {
        Headset headset(place);
        headset.show(scene, still(frame));
        handed = next_picture();
    }
    const int width = handed.eyes[0].width, height = handed.eyes[0].height;
    const view::Offscreen offscreen(width, height);
    view::SceneView view(scene);
    const RuntimeEye& told = handed.eyes[0].eye;
    const view::Pane pane{
        view::viewpoint(seen.X_WE[0], {told.left, told.right, told.up, told.down}, 0.03, 30)};
    view.draw(frame, std::array{pane}, width, height);
    const Image expected = offscreen.read(), picture = image_of(handed.eyes[0]);
    int other = 0;
    for (size_t i = 0; i < expected.rgb.size(); ++i)
        other += std::abs(expected.rgb[i] - picture.rgb[i]) > 2 ? 1 : 0;
    // edges may differ, because the pose was rounded to single precision
    EXPECT_LT(other, static_cast<int>(expected.rgb.size()) / 500);
}

TEST_F(HeadsetTest, TellsWhichTickWasSeenWhenAndFromWhere) {
    const display::Headset place = somewhere();
    Random random(5, "headset");
    const Seen seen = random_head(random, place.X_WS());
    pretend(seen.pretence);
    const scene::Scene scene = block_scene();
    const auto frames = std::make_shared<Headset::Frames>(frame_of(scene, -1));
    Headset headset(place);
    headset.show(scene, frames);
    next_picture();
    EXPECT_TRUE(headset.take_showings().empty()) << "no tick has been";
    frames->publish(frame_of(scene, 700));
    pretend(seen.pretence);
    const Handed handed = next_picture();
    const std::vector<Showing> showings = next_showings(headset);
    EXPECT_EQ(showings[0].tick, 700);
    EXPECT_TRUE(showings[0].tracked);
    EXPECT_LT((showings[0].X_WV.p - seen.X_WV.p).norm(), 1e-6);
    EXPECT_LT(angle_between(showings[0].X_WV.R, seen.X_WV.R), 1e-6);
    // the runtime's clock is the steady clock
    EXPECT_LE(std::abs(showings[0].at.time_since_epoch().count() - handed.time), 1'000'000'000);
    EXPECT_EQ(messages(), "");
}

TEST_F(HeadsetTest, TellsThatThePlaceOfTheHeadWasGuessed) {
    Pretence pretence = looks_ahead();
    pretence.tracked = false;
    pretend(pretence);
    const scene::Scene scene = block_scene();
    Headset headset({});
    headset.show(scene, still(frame_of(scene, 4)));
    next_picture();
    const std::vector<Showing> showings = next_showings(headset);
    EXPECT_FALSE(showings[0].tracked);
}

TEST_F(HeadsetTest, DrawsNothingThatNobodySeesAndNothingFromNowhere) {
    const scene::Scene scene = block_scene();
    Headset headset({});
    headset.show(scene, still(frame_of(scene, 4)));
    Pretence pretence = looks_ahead();
    pretence.visible = false;
    pretend(pretence);
    EXPECT_EQ(next_picture().layers, 0);
    pretence.visible = true;
    pretence.located = false;
    pretend(pretence);
    EXPECT_EQ(next_picture().layers, 0);
    pretence.located = true;
    pretend(pretence);
    EXPECT_EQ(next_picture().layers, 1);
    EXPECT_EQ(messages(), "");
}

TEST_F(HeadsetTest, HangsWordsUprightBeforeTheHead) {
    const display::Headset place = somewhere();
    Random random(6, "headset");
    const Seen seen = random_head(random, place.X_WS());
    pretend(seen.pretence);
    const scene::Scene scene = block_scene();
    Headset headset(place);
    headset.show(scene, still(frame_of(scene, 4)));
    EXPECT_TRUE(next_picture().words.rgba.empty());
    Words words;
    words.rgba.assign(size_t{4} * Words::kWidth * Words::kHeight, 0);
    // a red pixel in the upper left corner
    words.rgba[0] = words.rgba[3] = 255;
    headset.set_words(words);
    pretend(seen.pretence);
    const Handed with = next_picture();
    ASSERT_EQ(with.words.rgba.size(), words.rgba.size());
    const size_t upper_left = size_t{4} * Words::kWidth * (Words::kHeight - 1);
    EXPECT_EQ(with.words.rgba[upper_left], 255);
    EXPECT_EQ(with.words.rgba[upper_left + 1], 0);
    EXPECT_EQ(with.words.rgba[0], 0);
    // the words are one metre in front of the head, and are turned towards it
    const auto& X = with.words_pose;
    const Pose X_SP{Quat(X.R[3], X.R[0], X.R[1], X.R[2]), {X.p[0], X.p[1], X.p[2]}};
    const Vec3 ahead = seen.X_WV.R * Vec3(0, 0, -1);
    EXPECT_LT((place.X_WS() * X_SP.p - seen.X_WV.p - ahead).norm(), 1e-5);
    EXPECT_NEAR((X_SP.R * Vec3::UnitX()).y(), 0, 1e-6) << "its lines are level";
    EXPECT_GT((place.X_WS().R * (X_SP.R * Vec3::UnitZ())).dot(-ahead), 0.99);
    headset.set_words({});
    pretend(seen.pretence);
    EXPECT_TRUE(next_picture().words.rgba.empty());
    EXPECT_EQ(messages(), "");
}

TEST_F(HeadsetTest, SaysWhatIsMissing) {
    Pretence pretence;
    pretence.has_headset = false;
    pretend(pretence);
    {
        Headset headset({});
        const std::vector<Note> notes = notes_at_the_end(headset);
        ASSERT_EQ(notes.size(), 1);
        EXPECT_TRUE(notes[0].problem);
        EXPECT_EQ(notes[0].text,
                  "error: the tests' runtime does not find a headset. Connect the headset and "
                  "switch it on; then open the participant's window again.");
    }
    pretence.has_headset = true;
    pretence.has_stage = false;
    pretend(pretence);
    {
        display::Headset place;
        place.place = {"rig.yaml", 7};
        Headset headset(place);
        const std::vector<Note> notes = notes_at_the_end(headset);
        ASSERT_EQ(notes.size(), 1);
        EXPECT_NE(notes[0].text.find("rig.yaml"), std::string::npos) << notes[0].text;
        EXPECT_NE(notes[0].text.find("write space: local"), std::string::npos) << notes[0].text;
    }
    {
        display::Headset place;
        place.space = display::HeadsetSpace::local;
        const scene::Scene scene = block_scene();
        Headset headset(place);
        headset.show(scene, still(frame_of(scene, 4)));
        next_picture();
    }
    EXPECT_EQ(messages(), "");
}

TEST_F(HeadsetTest, SaysThatThereIsNoRuntime) {
    setenv("XR_RUNTIME_JSON", "/nowhere/manifest.json", 1);
    unsetenv("XR_ENABLE_API_LAYERS");
    Headset headset({});
    const std::vector<Note> notes = notes_at_the_end(headset);
    ASSERT_EQ(notes.size(), 1);
    EXPECT_NE(notes[0].text.find("there is no OpenXR runtime"), std::string::npos) << notes[0].text;
}

TEST_F(HeadsetTest, SaysThatThereIsNoDisplay) {
    unsetenv("DISPLAY");
    Headset headset({});
    const std::vector<Note> notes = notes_at_the_end(headset);
    ASSERT_EQ(notes.size(), 1);
    EXPECT_NE(notes[0].text.find("no X11 display can be opened"), std::string::npos)
        << notes[0].text;
}

TEST_F(HeadsetTest, EndsWithItsRuntime) {
    Pretence pretence = looks_ahead();
    pretend(pretence);
    const scene::Scene scene = block_scene();
    Headset headset({});
    headset.show(scene, still(frame_of(scene, 4)));
    next_picture();
    pretence.ends = true;
    pretend(pretence);
    const std::vector<Note> notes = notes_at_the_end(headset);
    EXPECT_EQ(notes.back().text,
              "error: the tests' runtime has ended the display in the headset. Restart it, then "
              "open the participant's window again.");
    EXPECT_EQ(messages(), "");
}

}  // namespace
}  // namespace dihaptic::headset::headset_test
