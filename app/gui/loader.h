// Reads and checks files in a thread of its own: a mesh may take a while to cut.
#pragma once

#include <QObject>
#include <optional>
#include <thread>

#include "device_panel.h"
#include "experiment/plan.h"
#include "session/resume.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

/// A file that is good, and what there is to show of it before it runs.
struct Opened {
    experiment::Plan plan;
    servo::Frame frame;  ///< the first
    /// What the devices say of themselves; none when they were not asked.
    std::optional<std::vector<DevicePanel::Device>> devices;
    std::vector<view::Workspace> workspaces;
    servo::WorkspaceTurn turn;
    /// Of a session that goes on with another: whose it is, and what to tell.
    std::optional<recording::Participant> participant;
    QStringList told;
};

/// What is to be opened.
struct Wanted {
    experiment::Request request;
    /// By a session, which opens real devices itself, so that they are not opened here.
    bool to_run = false;
    /// Folder of the session whose rest it is, in place of the request; "": none.
    std::string resumes;
};

class Loader : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~Loader() override;

    /// What was asked for before and is not done yet is dropped.
    void load(const Wanted& wanted);
    bool loading() const { return thread_.joinable(); }
    /// Ends what takes long; refused() says so.
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
