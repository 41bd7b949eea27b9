// Reads and checks files for the window, and opens the devices of its sessions, in a separate
// thread, because cutting up a mesh or waiting for a device may take a while.
#pragma once

#include <QObject>
#include <optional>
#include <thread>

#include "device_panel.h"
#include "session/plan.h"
#include "session/resume.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

/// A file without errors, and the scene as shown before a session runs.
struct Opened {
    session::Plan plan;
    frame::Frame frame;  ///< the first frame
    std::vector<DevicePanel::Device> devices;
    std::vector<view::Workspace> workspaces;
    servo::WorkspaceTurn turn;
    /// For a session that continues another session: its participant, its place in a study, and
    /// lines for the log.
    std::optional<recording::Participant> participant;
    std::optional<recording::InStudy> in_study;
    QStringList told;
};

/// What is to be opened.
struct Wanted {
    session::Request request;
    /// Whether a session will follow; if so, its devices are opened too.
    bool to_run = false;
    bool by_person = false;  ///< whether a simulated person moves the hand
    /// Folder of the session to resume, instead of the request's file; "" if none is resumed.
    std::string resumes;
    /// Text to be used instead of the contents of the request's file.
    std::optional<std::string> text = std::nullopt;
};

class Loader : public QObject {
    Q_OBJECT

  public:
    explicit Loader(QObject* parent = nullptr);
    ~Loader() override;

    /// Starts opening what is wanted. If an earlier call has not finished, its result is dropped.
    void load(const Wanted& wanted);
    bool loading() const { return thread_.joinable(); }
    /// The devices that were opened for the session that follows; null if none follows. To be
    /// called when opened() is emitted.
    std::unique_ptr<devices::DeviceGroup> take_devices() { return std::move(devices_); }
    /// Stops the reading of files and the cutting up of meshes; refused() then reports the
    /// cancellation.
    void cancel();

  Q_SIGNALS:
    void opened(const dihaptic::gui::Opened& opened);
    /// `of_file`: whether the problems are in the files, not in the devices that they name.
    void refused(const QStringList& problems, bool of_file);
    /// Emitted after one second of waiting, and again whenever the waiting time has doubled.
    /// `what`: the work that takes so long; `most`: its time limit [s].
    void waits(const QString& what, int seconds, int most);

  private:
    void run(const Wanted& wanted);
    void done(const std::optional<Opened>& result, const QStringList& problems, bool of_file);

    std::jthread thread_;
    std::optional<Wanted> next_;
    std::unique_ptr<devices::DeviceGroup> devices_;  // used by the thread while the thread runs
};

}  // namespace dihaptic::gui
