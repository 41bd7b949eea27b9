// Reads and checks files for the window, in a thread of its own: a mesh may take a while to cut.
#pragma once

#include <QObject>
#include <optional>
#include <thread>

#include "device_panel.h"
#include "experiment/plan.h"
#include "session/resume.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

/// A file without errors, and what can be shown of it before it runs.
struct Opened {
    experiment::Plan plan;
    servo::Frame frame;  ///< the first one
    /// What the devices report about themselves; nullopt when they were not asked.
    std::optional<std::vector<DevicePanel::Device>> devices;
    std::vector<view::Workspace> workspaces;
    servo::WorkspaceTurn turn;
    /// For a session that goes on with another one: its participant, and lines for the log.
    std::optional<recording::Participant> participant;
    QStringList told;
};

/// What to open.
struct Wanted {
    experiment::Request request;
    /// A session follows, which opens real devices itself: they are not opened here.
    bool to_run = false;
    /// Folder of the session to go on with, in place of the request; "": none.
    std::string resumes;
};

class Loader : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~Loader() override;

    /// Drops the result of a call before that is not done yet.
    void load(const Wanted& wanted);
    bool loading() const { return thread_.joinable(); }
    /// Ends reading and cutting of meshes; refused() says so.
    void cancel();

  Q_SIGNALS:
    void opened(const dihaptic::gui::Opened& opened);
    void refused(const QStringList& problems);

  private:
    void run(const Wanted& wanted);
    void done(const std::optional<Opened>& result, const QStringList& problems);

    std::thread thread_;
    std::optional<Wanted> next_;
};

}  // namespace dihaptic::gui
