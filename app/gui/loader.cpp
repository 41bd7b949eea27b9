#include "loader.h"

#include <atomic>

#include "base/companion.h"
#include "base/unsaved.h"
#include "person/population.h"

namespace dihaptic::gui {
namespace {

void describe_devices(Opened& out, const std::vector<Pose>& X_WD) {
    for (size_t i = 0; i < out.plan.devices.size(); ++i) {
        const frame::DeviceInfo& info = out.plan.devices[i];
        out.devices.push_back({QString::fromStdString(out.plan.scene.fingers[i].name),
                               QString::fromStdString(info.model),
                               out.plan.settings.safety.largest_force(info.peak_force)});
        if (info.workspace && !out.plan.rig.wall)
            out.workspaces.push_back({X_WD[i], *info.workspace});
    }
    if (const auto& wall = out.plan.rig.wall)
        out.workspaces.push_back({{Quat::Identity(), wall->centre}, wall->size});
}

void make_plan(Opened& out, const Wanted& wanted) {
    if (wanted.resumes.empty()) {
        out.plan = session::make_plan(wanted.request);
        if (wanted.by_person && out.plan.task)
            session::sit_down(out.plan, person::draw_person(person::Objects::device, out.plan.seed,
                                                            wanted.request.participant));
        return;
    }
    session::Rest rest = session::rest_of(wanted.resumes, session::Seat::window, {});
    out.told = QString::fromStdString(rest.describe()).split('\n', Qt::SkipEmptyParts);
    for (const Problem& warning : rest.warnings) out.told += QString::fromStdString(warning.text());
    out.participant = rest.before.participant;
    out.in_study = rest.before.in_study;
    out.plan = std::move(rest.plan);
}

/// `readable` becomes true when all files have been read without errors.
Opened open(const Wanted& wanted, std::unique_ptr<devices::DeviceGroup>& devices, bool& readable) {
    Opened out;
    make_plan(out, wanted);
    const std::vector<std::string> fingers = scene::finger_names(out.plan.scene);
    const std::vector<Pose> X_WD = rig::poses(out.plan.rig, fingers);
    out.turn = servo::WorkspaceTurn(X_WD);
    // the first frame is computed with simulated devices, without touching real ones
    session::Plan still = out.plan;
    still.rig = rig::simulated_rig(fingers);
    const auto resting = session::make_servo(still);
    resting->activate();
    out.frame = resting->tick(Time(0), {});
    readable = true;
    if (wanted.to_run) {
        devices =
            session::open_devices(out.plan, rig::is_real(out.plan.rig) ? host::program() : "",
                                  [stop = wanted.request.stop] { return stop.stop_requested(); });
    }
    describe_devices(out, X_WD);
    return out;
}

/// The loader to notify when a companion program must be waited for. The program has one window, so
/// there is only one loader.
std::atomic<Loader*> the_loader{nullptr};

void tell_of_wait(const std::string& what, int seconds, int most) {
    if (Loader* const loader = the_loader)
        Q_EMIT loader->waits(QString::fromStdString(what), seconds, most);
}

}  // namespace

Loader::Loader(QObject* parent) : QObject(parent) {
    the_loader = this;
    tell_companion_waits(tell_of_wait);
}

Loader::~Loader() {
    tell_companion_waits(nullptr);
    the_loader = nullptr;
    cancel();
    if (thread_.joinable()) thread_.join();
}

void Loader::cancel() {
    next_.reset();
    thread_.request_stop();
}

void Loader::load(const Wanted& wanted) {
    if (loading()) {
        next_ = wanted;
        return;
    }
    thread_ = std::jthread([this, now = wanted](const std::stop_token& stop) mutable {
        now.request.stop = stop;
        run(now);
    });
}

void Loader::run(const Wanted& wanted) {
    std::optional<Opened> result;
    QStringList problems;
    bool readable = false;
    devices_.reset();  // devices opened for a session that did not start
    std::optional<Unsaved> unsaved;
    if (wanted.text) unsaved.emplace(wanted.request.file, *wanted.text);
    try {
        result = open(wanted, devices_, readable);
    } catch (const Error& e) {
        for (const Problem& problem : e.problems())
            problems += QString::fromStdString(problem.text());
    } catch (const std::exception& e) {
        problems += QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this, [this, result, problems, readable] { done(result, problems, !readable); },
        Qt::QueuedConnection);
}

void Loader::done(const std::optional<Opened>& result, const QStringList& problems, bool of_file) {
    thread_.join();
    if (next_) {
        load(*std::exchange(next_, std::nullopt));
    } else if (result) {
        Q_EMIT opened(*result);
    } else {
        Q_EMIT refused(problems, of_file);
    }
}

}  // namespace dihaptic::gui
