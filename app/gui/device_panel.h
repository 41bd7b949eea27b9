// The panel that shows the state of the devices and of the servo loop.
#pragma once

#include <QLabel>
#include <QTableWidget>

#include "servo/servo.h"

namespace dihaptic::gui {

class DevicePanel : public QWidget {
    Q_OBJECT

  public:
    explicit DevicePanel(QWidget* parent = nullptr);

    struct Device {
        QString finger;
        QString model;
        double most_force = 0;  ///< largest force that was sent [N]
    };
    void set_devices(const std::vector<Device>& devices);
    /// Shows a frame. The figures of the servo loop cover only the frames that were shown.
    void show_frame(const frame::Frame& frame);
    /// Shows that no force acts, and why.
    void rest(const QString& why);

  private:
    void show_force(int device, double force);

    QTableWidget* table_;
    QLabel* loop_;
    std::vector<Device> devices_;
    int overruns_ = 0;
    int unbalanced_ = 0;
    int missed_ = 0;
    double lateness_ = 0;
    double tick_ = 0;
};

}  // namespace dihaptic::gui
