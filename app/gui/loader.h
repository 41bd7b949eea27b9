// Reads and checks files for the window, and opens the devices of its sessions, in a separate
// thread: cutting a mesh may take a while, as may a device's answer.
#pragma once

#include <QObject>
#include <optional>
#include <thread>

#include "device_panel.h"
#include "session/plan.h"
#include "session/resume.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

/// A file without errors, and its view before it runs.
struct Opened {
    session::Plan plan;
    frame::Frame frame;  ///< the first one
    std::vector<DevicePanel::Device> devices;
    std::vector<view::Workspace> workspaces;
    servo::WorkspaceTurn turn;
    /// For a session that continues another one: its participant, its place in a study,
    /// and lines for the log.
    std::optional<recording::Participant> participant;
    std::optional<recording::InStudy> in_study;
    QStringList told;
};

/// What to open.
struct Wanted {
    session::Request request;
    /// Whether a session follows, so that its devices are opened too; otherwise none are.
    bool to_run = false;
    bool by_person = false;  ///< a simulated person moves the hand
    /// Folder of the session to resume, in place of the request; "": none.
    std::string resumes;
    /// Text that replaces the content of the request's file.
    std::optional<std::string> text = std::nullopt;
};

class Loader : public QObject {
    Q_OBJECT

  public:
    explicit Loader(QObject* parent = nullptr);
    ~Loader() override;

    /// Opens what is wanted, and drops the result of an earlier call that is not finished.
    void load(const Wanted& wanted);
    bool loading() const { return thread_.joinable(); }
    /// The devices that were opened for the session that follows; null if none does. To be called
    /// when opened() is emitted.
    std::unique_ptr<devices::DeviceGroup> take_devices() { return std::move(devices_); }
    /// Ends reading and cutting of a scene's meshes; refused() reports it.
    void cancel();

  Q_SIGNALS:
    void opened(const dihaptic::gui::Opened& opened);
    void refused(const QStringList& problems);
    /// Emitted after a second, and again whenever that time has doubled, with the work that takes
    /// so long and its time limit [s].
    void waits(const QString& what, int seconds, int most);

  private:
    void run(const Wanted& wanted);
    void done(const std::optional<Opened>& result, const QStringList& problems);

    std::jthread thread_;
    std::optional<Wanted> next_;
    std::unique_ptr<devices::DeviceGroup> devices_;  // used by the thread while it runs
};

}  // namespace dihaptic::gui
