#include "analysis/bids.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "base/regular_file.h"
#include "base/table.h"
#include "base/text_file.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Channel {
    std::string name;
    std::string component;  ///< x, y, z, quat_x, ...; n/a
    std::string type;       ///< as Motion-BIDS has them; forces are MISC
    std::string point;      ///< that is tracked
    std::string unit;
    std::function<double(const servo::Frame&, size_t finger)> value;
};

/// Of a finger, in world axes.
std::vector<Channel> channels_of(const std::string& finger) {
    std::vector<Channel> out;
    const auto vector = [&](const std::string& what, const std::string& type,
                            const std::string& unit, Vec3 servo::FingerFrame::*field) {
        for (int i = 0; i < 3; ++i) {
            const std::string axis(1, "xyz"[i]);
            out.push_back({fmt::format("{}_{}_{}", finger, what, axis),
                           type == "MISC" ? "n/a" : axis, type,
                           what.starts_with("proxy") ? finger + "_proxy" : finger, unit,
                           [field, i](const servo::Frame& frame, size_t f) {
                               return (frame.fingers[f].*field)[i];
                           }});
        }
    };
    vector("position", "POS", "m", &servo::FingerFrame::p_WH);
    vector("velocity", "VEL", "m/s", &servo::FingerFrame::v_WH);
    vector("proxy_position", "POS", "m", &servo::FingerFrame::p_WP);
    vector("force_sent", "MISC", "N", &servo::FingerFrame::f_sent_W);
    vector("contact_force", "MISC", "N", &servo::FingerFrame::f_contact_W);
    out.push_back({finger + "_latency", "n/a", "LATENCY", "n/a", "s",
                   [](const servo::Frame& frame, size_t) { return seconds(frame.time); }});
    return out;
}

/// Labels of BIDS have letters and digits only.
std::string label(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) out += c;
    }
    return out.empty() ? "unnamed" : out;
}

/// A cell of a TSV, which has no quotes.
std::string tsv(std::string text) {
    if (text.empty()) return "n/a";
    for (char& c : text) {
        if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    }
    return text;
}

std::string lines(const std::vector<std::vector<std::string>>& rows) {
    std::string out;
    for (const auto& row : rows) {
        for (size_t i = 0; i < row.size(); ++i) out += (i > 0 ? "\t" : "") + tsv(row[i]);
        out += "\n";
    }
    return out;
}

std::vector<std::vector<std::string>> read_tsv(const std::string& file) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(read_text_file(file, kMostTable));
    for (std::string line; std::getline(in, line);) {
        std::vector<std::string>& row = rows.emplace_back();
        for (size_t at = 0; at <= line.size();) {
            const size_t end = std::min(line.find('\t', at), line.size());
            row.push_back(line.substr(at, end - at));
            at = end + 1;
        }
    }
    return rows;
}

enum class Known { stays, replaced };

/// Adds a row to a table, made with its header when it is not there.
void add_row(const std::string& file, const std::vector<std::string>& header,
             const std::vector<std::string>& row, Known known) {
    auto rows = is_there(file) ? read_tsv(file) : std::vector<std::vector<std::string>>{header};
    const auto same = [&](const auto& r) { return !r.empty() && r[0] == row[0]; };
    const auto found = std::find_if(rows.begin(), rows.end(), same);
    if (found == rows.end()) {
        rows.push_back(row);
    } else if (known == Known::stays) {
        return;
    } else {
        *found = row;
    }
    write_file(lines(rows), file);
}

/// One export at a time gives a data set's runs their numbers, and adds rows to its tables.
class DataSetLock {
  public:
    explicit DataSetLock(const std::string& folder)
        : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        // a file system without locks has none to wait for
        if (descriptor_ >= 0) ::flock(descriptor_, LOCK_EX);
    }
    ~DataSetLock() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    DataSetLock(const DataSetLock&) = delete;
    DataSetLock& operator=(const DataSetLock&) = delete;

  private:
    int descriptor_;
};

/// A folder for files in the making: what a killed export left there goes with the next one.
class Staging {
  public:
    explicit Staging(const std::string& folder) : path_(part_name(folder + "/.export")) {
        remove_dead_parts(folder + "/.export");
        std::error_code failed;
        fs::create_directories(path_, failed);
        if (failed) {
            throw Error({folder, 0}, "", "cannot be made: " + failed.message(),
                        "Name another folder.");
        }
    }
    ~Staging() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

class Exporter {
  public:
    Exporter(const recording::SessionFolder& session, const std::string& data_set)
        : session_(session),
          info_(session.read_info()),
          data_set_(data_set),
          subject_("sub-" + label(info_.participant.id.empty() ? "unknown" : info_.participant.id)),
          task_(label(fs::path(info_.experiment).stem().string())),
          folder_((fs::path(data_set) / subject_ / "motion").string()) {
        if (info_.state == recording::SessionState::running) {
            throw Error({session.file("session.yaml"), 0}, "", "the session has not ended",
                        "If it was killed, run: dihaptic recover " + session.path());
        }
    }

    Exported run(const std::function<void(double)>& progress) {
        recording::RawLogReader log(session_.raw_log());
        session_.check_log(info_, log.head());
        fingers_ = log.head().fingers;
        tick_ = log.head().tick;
        if (fingers_.empty()) {
            throw Error({session_.raw_log(), 0}, "", "has no finger, whose motion it would be",
                        "Give another session.");
        }
        const Staging staging(folder_);
        making_ = staging.path();
        write_motion(log, progress);
        for (size_t f = 0; f < fingers_.size(); ++f) {
            write_channels(fingers_[f], channels_[f]);
            write_description(fingers_[f], channels_[f]);
        }
        const bool events = write_events();
        const DataSetLock lock(data_set_);
        while (is_there(file(fingers_.front(), "motion.tsv"))) ++run_;
        write_data_set();
        give_names(events);
        Exported out{folder_, {}};
        if (log.health().damaged(info_.ticks))
            out.log = recording::describe(log.health(), info_.ticks, info_.planned());
        return out;
    }

  private:
    std::string stem() const { return fmt::format("{}_task-{}", subject_, task_); }
    std::string file(const std::string& finger, const std::string& what) const {
        return fmt::format("{}/{}_tracksys-{}_run-{:02}_{}", folder_, stem(), label(finger), run_,
                           what);
    }
    std::string events_file() const {
        return fmt::format("{}/{}_run-{:02}_events.tsv", folder_, stem(), run_);
    }
    /// The same while it is made.
    std::string making(const std::string& finger, const std::string& what) const {
        return fmt::format("{}/{}_{}", making_, label(finger), what);
    }

    void write_motion(recording::RawLogReader& log, const std::function<void(double)>& progress) {
        std::vector<std::ofstream> out;
        for (const std::string& finger : fingers_) {
            out.emplace_back(making(finger, "motion.tsv"));
            channels_.push_back(channels_of(finger));
        }
        std::string line;
        while (const servo::Frame* frame = log.next()) {
            for (size_t f = 0; f < fingers_.size(); ++f) {
                line.clear();
                for (const Channel& channel : channels_[f])
                    fmt::format_to(std::back_inserter(line), "{}{:.9g}", line.empty() ? "" : "\t",
                                   channel.value(*frame, f));
                out[f] << line << '\n';
            }
            if (++ticks_ % 5000 == 0 && progress) progress(log.share());
        }
        for (size_t f = 0; f < fingers_.size(); ++f) {
            out[f].close();
            if (out[f]) continue;
            throw Error({file(fingers_[f], "motion.tsv"), 0}, "", "cannot be written",
                        "Check the folder's permissions and the disk's space.");
        }
    }

    /// The first finger's motion is last: where it is, all of the run is.
    void give_names(bool events) const {
        const auto name = [](const std::string& from, const std::string& to) {
            std::error_code failed;
            fs::rename(from, to, failed);
            if (!failed) return;
            throw Error({to, 0}, "", "cannot be written: " + failed.message(),
                        "Check the folder's permissions and the disk's space.");
        };
        if (events) name(making_ + "/events.tsv", events_file());
        for (size_t f = fingers_.size(); f-- > 0;) {
            for (const char* what : {"channels.tsv", "channels.json", "motion.json", "motion.tsv"})
                name(making(fingers_[f], what), file(fingers_[f], what));
        }
    }

    void write_channels(const std::string& finger, const std::vector<Channel>& channels) {
        std::vector<std::vector<std::string>> rows{{"name", "component", "type", "tracked_point",
                                                    "units", "sampling_frequency",
                                                    "reference_frame"}};
        for (const Channel& c : channels)
            rows.push_back({c.name, c.component, c.type, c.point, c.unit,
                            fmt::format("{:g}", 1 / tick_), "global"});
        write_file(lines(rows), making(finger, "channels.tsv"));
        const Json levels{
            {"reference_frame",
             {{"Levels",
               {{"global",
                 {{"SpatialAxes", "RAS"},
                  {"RotationRule", "right-hand"},
                  {"RotationOrder", "n/a"},
                  {"Description", "x to the right, y away from the person, z up"}}}}}}}};
        write_file(levels.dump(2) + "\n", making(finger, "channels.json"));
    }

    void write_description(const std::string& finger, const std::vector<Channel>& channels) {
        std::map<std::string, int> counts;
        for (const Channel& c : channels) ++counts[c.type];
        std::string model = "unknown";
        for (const recording::DeviceRecord& device : info_.devices) {
            if (device.finger == finger) model = device.model;
        }
        Json json{{"TaskName", task_},
                  {"TaskDescription", info_.title},
                  {"SamplingFrequency", 1 / tick_},
                  {"TrackingSystemName", label(finger)},
                  {"ManufacturersModelName", model},
                  {"SoftwareVersions", info_.program},
                  {"MotionChannelCount", channels.size()},
                  {"TrackedPointsCount", 2},
                  {"RecordingType", "continuous"},
                  {"RecordingDuration", static_cast<double>(ticks_) * tick_}};
        for (const auto& [type, count] : counts) json[type + "ChannelCount"] = count;
        write_file(json.dump(2) + "\n", making(finger, "motion.json"));
    }

    /// Of all tracking systems, on their common time; false without any.
    bool write_events() {
        const std::string events = session_.file("events.csv");
        if (!is_there(events)) return false;
        const CsvFile csv(events);
        std::vector<std::vector<std::string>> rows{
            {"onset", "duration", "trial_type", "trial", "value"}};
        for (size_t i = 0; i < csv.rows(); ++i)
            rows.push_back({csv.text(i, "time_s"), "n/a", csv.text(i, "event"),
                            csv.text(i, "trial"), csv.text(i, "detail")});
        write_file(lines(rows), making_ + "/events.tsv");
        return true;
    }

    void write_data_set() {
        const auto top = [&](const char* name) { return (fs::path(data_set_) / name).string(); };
        if (!is_there(top("dataset_description.json"))) {
            const Json json{{"Name", info_.title},
                            {"BIDSVersion", "1.9.0"},
                            {"DatasetType", "raw"},
                            {"GeneratedBy", Json::array({{{"Name", info_.program}}})}};
            write_file(json.dump(2) + "\n", top("dataset_description.json"));
        }
        const recording::Participant& p = info_.participant;
        add_row(top("participants.tsv"), {"participant_id", "age", "sex", "handedness"},
                {subject_, p.age, p.sex, p.handedness}, Known::stays);
        const std::string scans =
            (fs::path(data_set_) / subject_ / (subject_ + "_scans.tsv")).string();
        for (const std::string& finger : fingers_) {
            const std::string name = fs::path(file(finger, "motion.tsv")).filename().string();
            add_row(scans, {"filename", "acq_time"},
                    {"motion/" + name, info_.started.substr(0, 19)}, Known::replaced);
        }
    }

    const recording::SessionFolder& session_;
    recording::SessionInfo info_;
    std::string data_set_;
    std::string subject_;
    std::string task_;
    std::string folder_;
    std::string making_;  // folder of files in the making
    int run_ = 1;
    std::vector<std::string> fingers_;
    std::vector<std::vector<Channel>> channels_;  // by finger
    double tick_ = 1e-3;                          // [s]
    int64_t ticks_ = 0;
};

}  // namespace

Exported export_bids(const recording::SessionFolder& session, const std::string& data_set,
                     const std::function<void(double)>& progress) {
    return Exporter(session, data_set).run(progress);
}

}  // namespace dihaptic::analysis
