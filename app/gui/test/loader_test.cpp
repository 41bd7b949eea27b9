// Tests that the window opens devices only for a session, and that the session takes them over.
#include "loader.h"

#include <gtest/gtest.h>

#include <QCoreApplication>

#include "answer_until.h"
#include "testing/files.h"

namespace dihaptic::gui {
namespace {

class LoaderTest : public ::testing::Test {
  protected:
    LoaderTest() {
        QObject::connect(&loader_, &Loader::opened, &loader_, [this](const Opened& opened) {
            opened_ = opened;
            devices_ = loader_.take_devices();
        });
        QObject::connect(&loader_, &Loader::refused, &loader_,
                         [this](const QStringList& problems) { problems_ = problems; });
    }

    /// Loads a scene and waits for the result. `rig`: path of a rig file; "" for simulated devices.
    void load(const std::string& rig, bool to_run) {
        Wanted wanted;
        wanted.request.file = "scenes/block-on-table.yaml";
        wanted.request.rig = rig;
        wanted.to_run = to_run;
        loader_.load(wanted);
        answer_until([this] { return opened_ || !problems_.isEmpty(); });
    }
    /// A rig of real devices whose maker's library is missing.
    std::string missing() {
        std::string text = "devices:\n";
        for (const char* finger : {"thumb", "index"}) {
            text += std::string("  - {finger: ") + finger +
                    ", backend: openhaptics, options: {library: /no/such.so, name: my " + finger +
                    "}}\n";
        }
        return folder_.write("rig.yaml", text);
    }

    int words_ = 1;
    char name_[2] = "t";
    char* argument_ = name_;
    QCoreApplication app_{words_, &argument_};
    testing::TemporaryFolder folder_;
    Loader loader_;
    std::optional<Opened> opened_;
    std::unique_ptr<devices::DeviceGroup> devices_;
    QStringList problems_;
};

TEST_F(LoaderTest, LeavesTheDevicesOfAnOpenFileAlone) {
    load(missing(), false);
    EXPECT_TRUE(problems_.isEmpty()) << problems_.join('\n').toStdString();
    ASSERT_TRUE(opened_);
    EXPECT_EQ(devices_, nullptr);
    ASSERT_EQ(opened_->devices.size(), 2u);
    EXPECT_EQ(opened_->devices[1].model, "my index");
}

TEST_F(LoaderTest, OpensTheDevicesOfASessionForItToTakeOver) {
    load("", true);
    ASSERT_TRUE(opened_);
    ASSERT_NE(devices_, nullptr);
    EXPECT_EQ(devices_->descriptions(), opened_->plan.devices);
    EXPECT_FALSE(devices_->active());
    EXPECT_EQ(loader_.take_devices(), nullptr);
}

TEST_F(LoaderTest, SaysWhyTheDevicesOfASessionCannotBeOpened) {
    load(missing(), true);
    EXPECT_FALSE(opened_);
    EXPECT_FALSE(problems_.isEmpty());
    EXPECT_EQ(devices_, nullptr);
}

}  // namespace
}  // namespace dihaptic::gui
