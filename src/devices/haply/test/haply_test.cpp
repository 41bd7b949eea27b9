// Tests the backend on the fake service: what it requires when it is set up, and the effects of
// faults.
#include <gtest/gtest.h>

#include "base/number.h"
#include "devices/haply/connection.h"
#include "devices/haply/group.h"
#include "devices/haply/inventory.h"
#include "devices/haply/messages.h"
#include "devices/haply/test/fake_service.h"
#include "devices/haply/test/numbered_run.h"
#include "testing/allocation_guard.h"
#include "testing/bounds.h"

namespace dihaptic::devices::haply::haply_test {
namespace {

using std::chrono::milliseconds;

/// A simulated hand whose fingers stay apart and turn slowly.
class TurningDriver final : public hand::Driver {
  public:
    static constexpr double kTurn = 0.5;  // [rad/s]
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        hand::FingerTarget target;
        target.p_WT = {0.05 * finger, 0.02, 0.03};
        target.R_WT = rotation_by({0, 0, kTurn * t});
        target.w_WT = {0, 0, kTurn};
        return target;
    }
    std::vector<Phase> phases_;
};

class Haply : public ::testing::Test {
  protected:
    Haply() { context_.driver = &driver_; }

    FakeService& serve(FakeService::Setup setup = {}) {
        if (setup.devices.empty()) setup.devices = {{"thumb", {}, {}}, {"index", {}, {}}};
        fingers_ = setup.devices;
        service_ = std::make_unique<FakeService>(setup, context_);
        return *service_;
    }
    std::unique_ptr<DeviceGroup> group(const std::string& more = "") {
        const std::string waits = "time_out_ms: " + number_text(time_out_ms_) + ", ";
        return make_group(rig_of(*service_, fingers_, waits + more), context_);
    }
    /// The error message with which activation fails.
    std::string refusal(const std::string& more = "") {
        try {
            group(more)->activate();
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

    TurningDriver driver_;
    Context context_;
    std::vector<DeviceConfig> fingers_;
    std::unique_ptr<FakeService> service_;
    int time_out_ms_ = 1000;  // long enough for a busy machine
};

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(HaplyUrl, IsParsed) {
    const auto url = Url::parse("ws://rig-3.lab:10001/path?x");
    ASSERT_TRUE(url);
    EXPECT_EQ(url->host, "rig-3.lab");
    EXPECT_EQ(url->port, 10001);
    EXPECT_EQ(url->path, "/path?x");
    EXPECT_EQ(Url::parse("ws://localhost")->port, 80);
    for (const char* wrong : {"", "localhost:10001", "wss://localhost:1/", "ws://:10001/",
                              "ws://localhost:0/", "ws://localhost:70000/", "ws://localhost:1x/"})
        EXPECT_FALSE(Url::parse(wrong)) << wrong;
}

class Messages : public ::testing::Test {
  protected:
    bool read(std::string text) {
        text_ = std::move(text);
        const size_t size = text_.size();
        text_.resize(size + Connection::kPadding);
        return reader_.read({text_.data(), size}, message_);
    }
    StateReader reader_{10000};
    StateMessage message_;
    std::string text_;
};

TEST_F(Messages, AreReadWithPartsThatAreLeftOut) {
    ASSERT_TRUE(read(R"({"session_id":"1","inverse3":[
        {"device_id":"049D","config":{"filters":{"a":[1,{}]}},
         "state":{"transform":{},"cursor_velocity":{"z":-2e-3},"cursor_position":{"y":0.25,"x":1}},
         "status":{"calibrated":true,"ready":false}},
        {"state":{"cursor_position":{}},"device_id":"04A1"}],
        "custom_verse_grip":[{}],
        "wireless_verse_grip":[{"device_id":"A0","state":{"orientation":{"x":1,"w":0},
        "buttons":{"a":true,"b":false,"c":true}}}]})"));
    ASSERT_EQ(message_.devices().size(), 2u);
    const DeviceState* thumb = message_.device("049D");
    ASSERT_NE(thumb, nullptr);
    EXPECT_EQ(*thumb->p_DH, Vec3(1, 0.25, 0));
    EXPECT_EQ(*thumb->v_DH, Vec3(0, 0, -2e-3));
    EXPECT_EQ(thumb->calibrated, true);
    EXPECT_EQ(thumb->ready, false);
    EXPECT_FALSE(thumb->power_supply);
    const DeviceState* index = message_.device("04A1");
    ASSERT_NE(index, nullptr);
    EXPECT_EQ(*index->p_DH, Vec3::Zero());
    EXPECT_FALSE(index->v_DH);
    const GripState* grip = message_.grip(GripKind::wireless_verse_grip, "A0");
    ASSERT_NE(grip, nullptr);
    EXPECT_EQ(grip->R->coeffs(), Quat(0, 1, 0, 0).coeffs());
    EXPECT_EQ(grip->buttons, 5u);
    EXPECT_EQ(message_.grip(GripKind::verse_grip, "A0"), nullptr);
    EXPECT_EQ(message_.device("049"), nullptr);
}

TEST_F(Messages, WithNumbersThatAreNoneSpoilOnlyTheirDevice) {
    for (const char* no_number : {"NaN", "nan", "-inf", "null", "\"0.1\"", "1e999", "{}"}) {
        ASSERT_TRUE(read(std::string(R"({"inverse3":[{"device_id":"1","state":{"cursor_position":)"
                                     R"({"x":)") +
                         no_number + R"(,"y":2}}},{"device_id":"2","state":{"cursor_position":)" +
                         R"({"x":3}}}]})"))
            << no_number;
        EXPECT_TRUE(std::isnan(message_.device("1")->p_DH->x())) << no_number;
        EXPECT_EQ(message_.device("1")->p_DH->y(), 2) << no_number;
        EXPECT_EQ(message_.device("2")->p_DH->x(), 3) << no_number;
    }
    ASSERT_TRUE(read(R"({"inverse3":[{"device_id":"1","state":{"cursor_position":null}}]})"));
    EXPECT_TRUE(message_.device("1")->p_DH->hasNaN());
}

TEST_F(Messages, ThatBreakOffAnywhereAreNone) {
    const std::string whole =
        R"({"session_id":"1","inverse3":[{"device_id":"049D","state":{"cursor_position":)"
        R"({"x":0.5,"y":1e-3},"cursor_velocity":{}},"status":{"ready":true}}]})";
    ASSERT_TRUE(read(whole));
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(read(whole.substr(0, size))) << whole.substr(0, size);
    for (const char* wrong :
         {"[]", "7", "null", "{} {}", R"({"inverse3":{}})", R"({"inverse3":[1]})", "<html></html>",
          "{\"inverse3\":[}]", R"({"inverse3":[{"state":{"cursor_position":nu}}]})"})
        EXPECT_FALSE(read(wrong)) << wrong;
}

TEST_F(Messages, OfTwoDevicesWithOneSerialNumberNeitherIsTaken) {
    ASSERT_TRUE(read(R"({"inverse3":[{"device_id":"1"},{"device_id":"1"},{"device_id":"2"}]})"));
    EXPECT_EQ(message_.device("1"), nullptr);
    EXPECT_NE(message_.device("2"), nullptr);
}

TEST(HaplyCommand, IsTheDocumentedOne) {
    CommandWriter writer({{"049D", ForceKey::vector}, {"04A1", ForceKey::values}});
    const std::vector<Vec3> forces{{0, -0.25, 1.5}, {1e-7, 0, -1.0 / 3}};
    EXPECT_EQ(writer.write(forces, true),
              R"({"session":{"configure":{"profile":{"name":"org.dihaptic:dihaptic"}}},)"
              R"("inverse3":[{"device_id":"049D","commands":{"set_cursor_force":)"
              R"({"vector":{"x":0,"y":-0.25,"z":1.5}}}},{"device_id":"04A1","commands":)"
              R"({"set_cursor_force":{"values":{"x":1e-07,"y":0,"z":-0.3333333333333333}}}}]})");
    EXPECT_EQ(writer.write(forces, false).substr(0, 14), R"({"inverse3":[{)");
}

TEST(HaplyOptions, AreChecked) {
    const auto problems = [](const std::string& yaml) {
        Diagnostics diagnostics;
        read_options({"thumb", {}, parse_yaml(yaml, "rig.yaml")}, diagnostics);
        std::string out;
        for (const Problem& problem : diagnostics.problems()) out += problem.text() + "\n";
        return out;
    };
    EXPECT_EQ(problems("{ device_id: 049D }"), "");
    EXPECT_SAYS(problems("{}"), "device_id");
    EXPECT_SAYS(problems("{ device_id: my device }"), "'my device' is not a serial number");
    EXPECT_SAYS(problems("{ device_id: 049D, url: http://localhost }"), "ws://localhost:10001/");
    EXPECT_SAYS(problems("{ device_id: 049D, force_key: torque }"), "values");
    EXPECT_SAYS(problems("{ device_id: 049D, time_out_ms: 0 }"), "time_out");
    EXPECT_SAYS(problems("{ device_id: 049D, verse_grip: 1, wireless_verse_grip: 2 }"), "one grip");
}

TEST_F(Haply, NeedsDifferentDevicesOfOneService) {
    serve();
    auto configs = rig_of(*service_, fingers_);
    configs[1].options = configs[0].options;
    EXPECT_THROW(make_group(configs, context_), Error);
    configs[1].options = parse_yaml("{ device_id: 04A1, url: 'ws://elsewhere:1/' }", "rig.yaml");
    EXPECT_THROW(make_group(configs, context_), Error);
}

TEST_F(Haply, ReadsAndPushesTheDevicesBehindTheService) {
    serve();
    const auto devices = group();
    std::vector<Reading> readings(2);
    devices->activate();
    devices->read(Time(0), readings);
    EXPECT_EQ(readings[0].status, 0u);
    EXPECT_EQ(readings[1].p_DH, Vec3(0.05, 0.02, 0.03));
    for (int i = 1; i <= 50; ++i) {
        devices->write(std::vector<Wrench>{{Vec3(0, 0, 1)}, {Vec3(0, -9, 0)}});
        devices->read(milliseconds(i), readings);
    }
    EXPECT_GT(readings[0].p_DH.z(), 0.031);
    EXPECT_LT(readings[1].p_DH.y(), 0.01);
    EXPECT_EQ(readings[0].status, 0u);
    EXPECT_EQ(readings[1].status, kForceClamped);
    devices->deactivate();
    const auto received = service_->received();
    ASSERT_EQ(received.size(), 52u);  // 50, plus one with zero force before and after
    EXPECT_EQ(received.front()[0], Vec3::Zero());
    EXPECT_EQ(received[1][0], Vec3(0, 0, 1));
    EXPECT_EQ(received[1][1], Vec3(0, -5, 0));
    EXPECT_EQ(received.back()[1], Vec3::Zero());
}

TEST_F(Haply, SendsNoForceThatIsNotANumber) {
    serve();
    const auto devices = group();
    std::vector<Reading> readings(2);
    devices->activate();
    devices->read(Time(0), readings);
    const double nan = std::nan("");
    devices->write(std::vector<Wrench>{{Vec3(0, nan, 1)}, {Vec3(0, 1, 0)}});
    devices->read(milliseconds(1), readings);
    EXPECT_EQ(service_->received().back()[0], Vec3::Zero());
    EXPECT_EQ(service_->received().back()[1], Vec3(0, 1, 0));
}

TEST_F(Haply, TakesOrientationAndButtonsFromAGrip) {
    FakeService::Setup setup;
    setup.grips = true;
    setup.devices = {{"hand", {}, parse_yaml("{ orientation: yes, buttons: 4 }", "rig.yaml")}};
    serve(setup);
    const auto devices = group("wireless_verse_grip: A0, ");
    EXPECT_TRUE(devices->info(0).measures_orientation);
    std::vector<Reading> readings(1);
    devices->activate();
    for (int i = 0; i < 1000; ++i) {
        devices->read(milliseconds(i), readings);
        devices->write(std::vector<Wrench>(1));
        ASSERT_EQ(readings[0].status, 0u);
        EXPECT_EQ(readings[0].buttons, 4u);
        EXPECT_NEAR(readings[0].R_DH.norm(), 1, 1e-9);
    }
    EXPECT_NEAR(rotation_vector(readings[0].R_DH).z(), TurningDriver::kTurn, 0.05);
    EXPECT_NEAR(readings[0].w_DH.z(), TurningDriver::kTurn, 0.05);
    EXPECT_FALSE(group()->info(0).measures_orientation);
    EXPECT_SAYS(refusal("wireless_verse_grip: A7, "), "It lists: A0");
}

TEST_F(Haply, SaysWhatKeepsItFromStarting) {
    FakeService::Setup setup;
    setup.not_calibrated = "04A1";
    serve(setup);
    EXPECT_SAYS(refusal(), "'04A1' is not calibrated");
    setup = {};
    setup.not_ready = "049D";
    serve(setup);
    EXPECT_SAYS(refusal(), "'049D' is not ready");
    setup = {};
    setup.no_power = "049D";
    serve(setup);
    EXPECT_SAYS(refusal(), "'049D' has no power");
    setup = {};
    setup.ids = {"049D", "049D"};
    serve(setup);
    fingers_.pop_back();
    EXPECT_SAYS(refusal(), "lists 2 devices '049D'");
    setup = {};
    setup.refused_key = "vector";
    serve(setup);
    EXPECT_SAYS(refusal(), "unknown field 'vector'");
    EXPECT_SAYS(refusal(), "try force_key: values");
    EXPECT_EQ(refusal("force_key: values, "), "");
    setup = {};
    setup.refuses_http = true;
    serve(setup);
    EXPECT_SAYS(refusal(), "refused a WebSocket handshake");
    setup = {};
    setup.garbage = true;
    serve(setup);
    EXPECT_SAYS(refusal(), "is not a WebSocket service");
    for (const char* greeting : {"{\"inverse3\":[", "hello", "[]"}) {
        setup = {};
        setup.greeting = greeting;
        serve(setup);
        EXPECT_SAYS(refusal(), "not a complete JSON object");
    }
    setup = {};
    setup.greeting = "{}";
    serve(setup);
    EXPECT_SAYS(refusal(), "It lists: none");
}

TEST_F(Haply, ListsWhatThereIsWhenADeviceIsNot) {
    serve();
    const auto devices =
        make_group({{"thumb",
                     {},
                     parse_yaml("{ device_id: BEEF, url: '" + service_->url() + "' }", "r.yaml")}},
                   context_);
    try {
        devices->activate();
        FAIL();
    } catch (const Error& e) {
        EXPECT_SAYS(std::string(e.what()), "does not list an Inverse3 'BEEF'");
        EXPECT_SAYS(std::string(e.what()), "It lists: 049D, 04A1.");
    }
}

TEST_F(Haply, SaysThatNothingListens) {
    serve();
    const auto devices = group();
    const std::string url = service_->url();
    service_.reset();
    try {
        devices->activate();
        FAIL();
    } catch (const Error& e) {
        EXPECT_SAYS(std::string(e.what()), "Connection refused");
        EXPECT_SAYS(std::string(e.what()), "systemctl start haply-inverse-service");
    }
    EXPECT_SAYS(survey_of(url).missing, "Connection refused");
    EXPECT_TRUE(survey_of(url).devices.empty());
    EXPECT_SAYS(survey_of("ws://" + std::string(70, 'x') + ":1/").missing,
                "there is no computer named xxx");
}

TEST_F(Haply, SurveysWhatTheServiceLists) {
    FakeService::Setup setup;
    setup.grips = true;
    setup.not_calibrated = "04A1";
    serve(setup);
    const Survey survey = survey_of(service_->url());
    EXPECT_EQ(survey.missing, "");
    ASSERT_EQ(survey.devices.size(), 4u);
    EXPECT_EQ(survey.devices[0].serial, "049D");
    EXPECT_EQ(survey.devices[0].model, "Haply Inverse3");
    EXPECT_EQ(survey.devices[0].state, "ready");
    EXPECT_SAYS(survey.devices[1].state, "is not calibrated");
    EXPECT_EQ(survey.devices[3].serial, "A1");
    setup = {};
    setup.greeting = "{}";
    serve(setup);
    EXPECT_SAYS(survey_of(service_->url()).missing, "lists no Inverse3");
}

struct Trouble {
    Mischief what;
    bool one_device = false;  ///< whether only one of the two devices is affected
    bool ends = true;         ///< whether the fault ends the connection
};
class HaplyTrouble : public Haply, public ::testing::WithParamInterface<Trouble> {};

TEST_P(HaplyTrouble, IsAStatusNoHangAndOverAfterANewStart) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    time_out_ms_ = 200;
    serve().misbehave(GetParam().what, 10, 1, milliseconds(500));
    const auto devices = group();
    std::vector<Reading> readings(2);
    const std::vector<Wrench> forces(2, {Vec3(0.5, 0, 0)});
    devices->activate();
    {
        const testing::AllocationGuard guard;
        for (int i = 0; i < 20; ++i) {
            devices->read(milliseconds(i), readings);
            devices->write(forces);
            const bool ill = i >= 10;
            if (GetParam().what == Mischief::not_a_number) {
                ASSERT_EQ(readings[1].p_DH.hasNaN(), ill) << i;
                ASSERT_EQ(readings[1].status, 0u);
            } else {
                ASSERT_EQ(readings[1].status, ill ? kNotAnswering : 0u) << i;
                ASSERT_TRUE(readings[1].p_DH.allFinite());
            }
            const bool other_ill = ill && !GetParam().one_device;
            ASSERT_EQ(readings[0].status, other_ill ? kNotAnswering : 0u) << i;
        }
        EXPECT_EQ(guard.count(), 0u);
    }
    devices->deactivate();
    if (!GetParam().ends) return;
    devices->activate();
    devices->read(Time(0), readings);
    devices->write(forces);
    devices->read(milliseconds(1), readings);
    EXPECT_EQ(readings[0].status, 0u);
    EXPECT_EQ(readings[1].status, 0u);
    EXPECT_EQ(service_->received().back()[1], Vec3(0.5, 0, 0));
}
INSTANTIATE_TEST_SUITE_P(Service, HaplyTrouble,
                         ::testing::Values(Trouble{Mischief::late}, Trouble{Mischief::silent},
                                           Trouble{Mischief::half_message},
                                           Trouble{Mischief::half_json, false, false},
                                           Trouble{Mischief::not_a_number, true, false},
                                           Trouble{Mischief::leaves_out, true, false},
                                           Trouble{Mischief::loses_calibration, true, false},
                                           Trouble{Mischief::complains, false, false},
                                           Trouble{Mischief::closes}));

TEST_F(Haply, BearsAnAnswerThatIsALittleLate) {
    serve().misbehave(Mischief::late, 10, 0, milliseconds(5));
    const auto devices = group();
    std::vector<Reading> readings(2);
    devices->activate();
    for (int i = 0; i < 20; ++i) {
        devices->read(milliseconds(i), readings);
        devices->write(std::vector<Wrench>(2));
        EXPECT_EQ(readings[0].status | readings[1].status, 0u);
    }
}

class HaplyRate : public Haply, public ::testing::WithParamInterface<double> {};

TEST_P(HaplyRate, LosesAndDoublesNoCommand) {
    FakeService::Setup setup;
    setup.rate = GetParam();
    serve(setup);
    const auto devices = group();
    EXPECT_TRUE(devices->paces());
    devices->activate();
    const NumberedRun first =
        expect_no_command_lost_or_doubled(*devices, *service_, 1, static_cast<int>(GetParam() / 4));
    // a pause, which begins in the same way as in Servo::rest()
    devices->write(std::vector<Wrench>(2));
    devices->write(std::vector<Wrench>(2));
    expect_no_command_lost_or_doubled(*devices, *service_, first.sent + 2, 20);
}
INSTANTIATE_TEST_SUITE_P(Service, HaplyRate, ::testing::Values(1000.0, 2000.0, 4000.0));

TEST_F(Haply, CanBeStoppedWhileItWaits) {
    serve().misbehave(Mischief::silent, 10);
    const auto devices = group();
    std::vector<Reading> readings(2);
    devices->activate();
    std::thread stopper;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i <= 10; ++i) {
        if (i == 10) {
            stopper = std::thread([&] {
                std::this_thread::sleep_for(milliseconds(20));
                devices->stop();
            });
        }
        devices->read(milliseconds(i), readings);
        devices->write(std::vector<Wrench>(2));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(900));
    EXPECT_EQ(readings[0].status, kNotAnswering);
    stopper.join();
}

TEST(HaplyOptions, HaveBounds) {
    testing::expect_bounds<Options>();
}

}  // namespace
}  // namespace dihaptic::devices::haply::haply_test
