#include "analysis/bids.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/bids/data_set.h"
#include "analysis/bids/events.h"
#include "analysis/bids/motion.h"
#include "analysis/ended.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "recording/raw_log.h"
#include "recording/seal.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;
using bids::label;
using bids::TrackingSystem;

class Exporter {
  public:
    Exporter(const recording::SessionFolder& session, const std::string& data_set)
        : session_(session),
          info_(session.read_info()),
          folder_of_set_(data_set),
          data_set_(data_set, session_, info_),
          task_(fs::path(info_.experiment).stem().string()),
          folder_((fs::path(data_set) / data_set_.place() / "motion").string()) {
        check_ended(session, info_);
    }

    Exported run(const std::function<void(double)>& progress) {
        recording::RawLogReader log(session_.raw_log());
        session_.check_log(info_, log.head());
        tick_ = log.head().tick;
        if (log.head().fingers.empty()) {
            throw Error({session_.raw_log(), 0}, "", "has no finger whose motion could be exported",
                        "Give another session.");
        }
        systems_ = bids::tracking_systems(session_, info_, log.head());
        data_set_.check();  // fail before the lengthy work
        make_folders(folder_of_set_, data_set_.place() + "/motion");
        remove_dead_parts(folder_ + "/.export");
        const Output staging(folder_ + "/.export");
        fs::create_directory(staging.path());
        making_ = staging.path();
        write_motion(log, progress);
        for (const TrackingSystem& system : systems_) {
            write_file(bids::channels_tsv(system, tick_), making(system, "channels.tsv"));
            write_file(bids::channels_json(), making(system, "channels.json"));
            write_file(bids::motion_json(system, task_, info_, tick_, ticks_),
                       making(system, "motion.json"));
        }
        const bool events = write_events();
        const bids::Lock lock(folder_of_set_);
        data_set_.check();
        while (is_there(file(systems_.front(), "motion.tsv"))) ++run_;
        check_task();
        data_set_.add(recordings());
        give_names(events);
        constexpr std::string_view kRead[] = {"events.csv", "trials.csv", "lifts.csv",
                                              "trials-before.csv"};
        Exported out{
            folder_, recording::broken_seals(session_, info_, Severity::warning, kRead), {}};
        if (log.health().damaged(info_.ticks))
            out.log = recording::describe(log.health(), info_.ticks, info_.planned());
        return out;
    }

  private:
    /// Prefix of the paths of the run's files, relative to the subject's folder.
    std::string stem() const {
        return fmt::format("{}/{}_task-{}", folder_, data_set_.stem(), label(task_));
    }
    std::string file(const TrackingSystem& system, const std::string& what) const {
        return fmt::format("{}_tracksys-{}_run-{:02}_{}", stem(), label(system.name), run_, what);
    }
    std::string events_file(const char* extension) const {
        return fmt::format("{}_run-{:02}_events.{}", stem(), run_, extension);
    }
    /// Path of one of the run's files while it is being written.
    std::string making(const TrackingSystem& system, const std::string& what) const {
        return fmt::format("{}/{}_{}", making_, label(system.name), what);
    }
    std::vector<std::string> recordings() const {
        std::vector<std::string> out;
        for (const TrackingSystem& system : systems_)
            out.push_back("motion/" + fs::path(file(system, "motion.tsv")).filename().string());
        return out;
    }

    void write_motion(recording::RawLogReader& log, const std::function<void(double)>& progress) {
        std::vector<std::ofstream> out;
        for (const TrackingSystem& system : systems_)
            out.emplace_back(making(system, "motion.tsv"));
        std::string line;
        while (const frame::Frame* frame = log.next()) {
            for (size_t i = 0; i < systems_.size(); ++i) {
                line.clear();
                for (const bids::Channel& channel : systems_[i].channels) {
                    if (!line.empty()) line += '\t';
                    const double value = channel.value(*frame);
                    if (std::isnan(value)) {
                        line += "n/a";  // the row comes after a gap in the recording
                    } else {
                        fmt::format_to(std::back_inserter(line), "{:.9g}", value);
                    }
                }
                out[i] << line << '\n';
            }
            if (++ticks_ % 5000 == 0 && progress) progress(log.share());
        }
        for (size_t i = 0; i < systems_.size(); ++i) {
            out[i].close();
            if (out[i]) continue;
            throw Error({file(systems_[i], "motion.tsv"), 0}, "", "cannot be written",
                        "Check the folder's permissions and the disk's space.");
        }
    }

    /// Writes the events, which are common to all tracking systems. Returns false if there are
    /// none.
    bool write_events() const {
        const auto events = bids::events_of(session_, info_);
        if (!events) return false;
        write_file(bids::to_tsv(events->rows), making_ + "/events.tsv");
        write_file(events->json, making_ + "/events.json");
        return true;
    }

    /// Throws Error when another task in the data set has the same label, because both tasks would
    /// look like runs of one task.
    void check_task() const {
        for (int run = 1; run < run_; ++run) {
            const std::string there = fmt::format("{}_tracksys-{}_run-{:02}_motion.json", stem(),
                                                  label(systems_.front().name), run);
            if (!is_there(there)) continue;
            const auto json = nlohmann::json::parse(read_text_file(there), nullptr, false);
            const std::string name =
                json.is_object() && json.contains("TaskName") && json["TaskName"].is_string()
                    ? json["TaskName"].get<std::string>()
                    : "";
            // earlier versions stored the label as the name of the task
            if (name.empty() || name == task_ || name == label(task_)) continue;
            throw Error({there, 0}, "TaskName",
                        fmt::format("is {}, but {} would have the same label in file names: {}",
                                    name, task_, label(task_)),
                        "Name another folder, or rename the experiment's file before the session.");
        }
    }

    /// Gives the files their final names. The motion file of the first finger is renamed last: if
    /// it exists, the run is complete.
    void give_names(bool events) const {
        const auto name = [](const std::string& from, const std::string& to) {
            check_replaceable(to);
            std::error_code failed;
            fs::rename(from, to, failed);
            if (!failed) return;
            throw Error({to, 0}, "", "cannot be written: " + failed.message(),
                        "Check the folder's permissions and the disk's space.");
        };
        for (const char* extension : {"tsv", "json"}) {
            if (events)
                name(fmt::format("{}/events.{}", making_, extension), events_file(extension));
        }
        for (size_t i = systems_.size(); i-- > 0;) {
            for (const char* what : {"channels.tsv", "channels.json", "motion.json", "motion.tsv"})
                name(making(systems_[i], what), file(systems_[i], what));
        }
    }

    const recording::SessionFolder& session_;
    recording::SessionInfo info_;
    std::string folder_of_set_;
    bids::DataSet data_set_;
    std::string task_;    // name of the task
    std::string folder_;  // folder of the motion files
    std::string making_;  // folder of unfinished files
    int run_ = 1;
    std::vector<TrackingSystem> systems_;
    double tick_ = 1e-3;  // [s]
    int64_t ticks_ = 0;
};

}  // namespace

Exported export_bids(const recording::SessionFolder& session, const std::string& data_set,
                     const std::function<void(double)>& progress) {
    return Exporter(session, data_set).run(progress);
}

bool is_exported(const recording::SessionFolder& session, const std::string& data_set) {
    const recording::SessionInfo info = session.read_info();
    return !bids::DataSet(data_set, session, info).recording_there().empty();
}

}  // namespace dihaptic::analysis
