// Tests what the panel of devices says about each device.
#include "device_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QTableWidget>

#include "base/status.h"

namespace dihaptic::gui::device_panel_test {
namespace {

TEST(DevicePanel, CallsNoDeviceAllRightWhileForceIsOff) {
    int count = 1;
    char name[5] = "test";
    char* names[2] = {name, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QApplication application(count, names);
    DevicePanel panel;
    panel.set_devices({{"thumb", "a device", 8.5}, {"index", "a device", 8.5}});
    const auto* table = panel.findChild<QTableWidget*>();
    const auto status = [&](int device) { return table->item(device, 3)->text(); };
    frame::Frame frame;
    frame.fingers.resize(2);
    panel.show_frame(frame);
    EXPECT_EQ(status(0), "OK");
    frame.status = kForceOff;
    frame.fingers[1].status = kDeviceFault;
    panel.show_frame(frame);
    EXPECT_EQ(status(0), "force off");
    EXPECT_NE(status(1), "OK");
    EXPECT_NE(status(1), "force off");
    panel.rest("idle");
    EXPECT_EQ(status(1), "idle");
}

}  // namespace
}  // namespace dihaptic::gui::device_panel_test
