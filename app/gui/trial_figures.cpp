#include "trial_figures.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "analysis/running_trials.h"

namespace dihaptic::gui {
namespace {

constexpr auto kEvery = std::chrono::milliseconds(500);

void wait(const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::unique_lock lock(mutex);
    changed.wait_for(lock, stop, kEvery, [&] { return stop.stop_requested(); });
}

}  // namespace

TrialFigures::TrialFigures() = default;
TrialFigures::~TrialFigures() = default;

void TrialFigures::follow(const QString& folder) {
    over_ = false;
    thread_ = std::jthread([this, folder = folder.toStdString()](const std::stop_token& stop) {
        try {
            analysis::RunningTrials trials(folder);
            size_t told = 0;
            bool again = false;  // figures of an attempt are complete only one tick after its end
            while (!stop.stop_requested()) {
                const bool last = over_;
                trials.look();
                const size_t ended = trials.ended();
                if (ended != told || again) tell(trials.table(), stop);
                again = std::exchange(told, ended) != ended;
                if (last) return;
                wait(stop);
            }
        } catch (const Error&) {
            // no trials or missing files: the fault is reported at the end of the session
        }
    });
}

void TrialFigures::tell(Table table, const std::stop_token& stop) {
    QMetaObject::invokeMethod(this, [this, stop, table = std::move(table)] {
        if (!stop.stop_requested()) Q_EMIT found(table);
    });
}

}  // namespace dihaptic::gui
