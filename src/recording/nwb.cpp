#include "recording/nwb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "base/disk.h"
#include "base/output.h"
#include "base/shell_word.h"
#include "recording/codes.h"
#include "recording/frame_row.h"
#include "recording/hdf5.h"
#include "recording/raw_log.h"

namespace dihaptic::recording {
namespace {

using hdf5::create_group;
using hdf5::Id;
using hdf5::write_attribute;
using hdf5::write_dataset;

/// Returns a random UUID (version 4), which NWB requires for every object.
std::string new_uuid() {
    static std::mt19937_64 engine{std::random_device{}()};
    const uint64_t a = (engine() & ~0xF000ULL) | 0x4000ULL;
    const uint64_t b = (engine() & ~(3ULL << 62)) | (2ULL << 62);
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", a >> 32, (a >> 16) & 0xFFFF,
                       a & 0xFFFF, b >> 48, b & 0xFFFFFFFFFFFFULL);
}

void mark(hid_t object, const std::string& type, const std::string& space = "core") {
    write_attribute(object, "namespace", space);
    write_attribute(object, "neurodata_type", type);
    write_attribute(object, "object_id", new_uuid());
}

/// NWB uses words for SI units; other units keep their symbols.
std::string nwb_unit(const std::string& unit) {
    static const std::map<std::string, std::string> kWords{{"m", "meters"},
                                                           {"m/s", "meters/second"},
                                                           {"N", "newtons"},
                                                           {"N*m", "newton meters"},
                                                           {"rad/s", "radians/second"},
                                                           {"s", "seconds"},
                                                           {"1", "n/a"}};
    const auto found = kWords.find(unit);
    return found == kWords.end() ? unit : found->second;
}

/// A time series with a value for every tick.
class Series {
  public:
    /// `frame` is the frame in which positions are expressed; "" if the quantity is not a position.
    Series(hid_t acquisition, const std::string& name, size_t columns, const std::string& unit,
           const std::string& description, const std::string& frame,
           hdf5::Numbers numbers = hdf5::Numbers::real)
        : group_(create_group(acquisition, name)), rows_(group_, "data", columns, numbers) {
        mark(group_, frame.empty() ? "TimeSeries" : "SpatialSeries");
        write_attribute(group_, "description", description);
        write_attribute(group_, "comments", "no comments");
        write_attribute(rows_.dataset(), "unit", nwb_unit(unit));
        write_attribute(rows_.dataset(), "conversion", 1.0F);
        write_attribute(rows_.dataset(), "offset", 0.0F);
        write_attribute(rows_.dataset(), "resolution", -1.0F);
        if (!frame.empty()) write_dataset(group_, "reference_frame", frame);
    }
    void add(const double* row) { rows_.add(row); }
    void close(double tick, const std::vector<double>* times) {
        rows_.finish();
        if (times == nullptr) {
            const Id start = write_dataset(group_, "starting_time", 0.0);
            write_attribute(start, "rate", static_cast<float>(1 / tick));
            write_attribute(start, "unit", "seconds");
        } else {
            hdf5::Rows stamps(group_, "timestamps", 1, hdf5::Numbers::exact);
            for (const double time : *times) stamps.add(&time);
            stamps.finish();
            write_attribute(stamps.dataset(), "interval", int32_t{1});
            write_attribute(stamps.dataset(), "unit", "seconds");
        }
    }

  private:
    Id group_;
    hdf5::Rows rows_;
};

/// Describes a quantity and its axes.
std::string words_of(const frame::Term& term) {
    const std::string frame = term.frame;
    const char* const axes = frame == "W"   ? " In the world's axes."
                             : frame == "D" ? " In the device's axes."
                                            : "";
    return std::string(term.meaning) + axes;
}

/// The columns of a list's table, in the order used by FrameRow.
class ListColumns {
  public:
    struct Column {
        std::string name;
        std::string description;
        hdf5::Numbers numbers;
    };
    template <class T>
    void operator()(const T&, const frame::Term& term) {
        const std::string parts = std::is_same_v<T, Vec3>   ? "xyz"
                                  : std::is_same_v<T, Quat> ? "wxyz"
                                                            : "";
        std::string words = words_of(term);
        if (term.unit != std::string("1")) words += fmt::format(" [{}]", term.unit);
        constexpr bool whole = std::is_integral_v<T> || std::is_enum_v<T>;
        const auto numbers = whole ? hdf5::Numbers::whole : hdf5::Numbers::real;
        if (parts.empty()) columns.push_back({term.name, words, numbers});
        for (const char part : parts)
            columns.push_back({fmt::format("{}_{}", term.name, part), words, numbers});
    }
    std::vector<Column> columns;
};

/// A list whose number of items varies between ticks becomes a table with one row per item. As a
/// series, such a list would often have more columns than rows, and NWB readers would mistake its
/// columns for points in time.
class ListTable {
  public:
    ListTable(hid_t acquisition, const std::string& name, const std::string& meaning,
              const std::vector<ListColumns::Column>& columns)
        : group_(create_group(acquisition, name)), ids_(group_, "id", 1, hdf5::Numbers::whole) {
        mark(group_, "DynamicTable", "hdmf-common");
        write_attribute(group_, "description", meaning);
        mark(ids_.dataset(), "ElementIdentifiers", "hdmf-common");
        std::vector<std::string> names;
        add_column({"time", "Session time of the tick [s]", hdf5::Numbers::exact}, names);
        for (const ListColumns::Column& column : columns) add_column(column, names);
        write_attribute(group_, "colnames", names);
    }
    void add(double time, const std::vector<double>& numbers) {
        const auto id = static_cast<double>(ids_.count());
        ids_.add(&id);
        columns_[0].add(&time);
        for (size_t i = 0; i < numbers.size(); ++i) columns_[i + 1].add(&numbers[i]);
    }
    void close() {
        ids_.finish();
        for (hdf5::Rows& column : columns_) column.finish();
    }

  private:
    void add_column(const ListColumns::Column& column, std::vector<std::string>& names) {
        names.push_back(column.name);
        hdf5::Rows& rows = columns_.emplace_back(group_, column.name, 1, column.numbers);
        mark(rows.dataset(), "VectorData", "hdmf-common");
        write_attribute(rows.dataset(), "description", column.description);
    }

    Id group_;
    hdf5::Rows ids_;
    std::vector<hdf5::Rows> columns_;
};

/// Converts frames into series, one for each field that Frame::visit() names. The series are
/// created when the first frame is added.
class FrameExporter {
  public:
    FrameExporter(hid_t acquisition, const RawLogReader& log)
        : acquisition_(acquisition),
          head_(log.head()),
          not_recorded_(log.health().not_recorded),
          turning_(log.head().turning_fingers()) {}

    void add(const frame::Frame& frame) {
        next_ = 0;
        times_.push_back(seconds(frame.time));
        regular_ = regular_ && std::abs(times_.back() - static_cast<double>(times_.size() - 1) *
                                                            head_.tick) < 1e-12;
        frame::Frame::visit(frame, *this);
    }
    void close() {
        for (Series& series : series_) series.close(head_.tick, regular_ ? nullptr : &times_);
        for (auto& [name, list] : lists_) list.close();
    }

    // called by Frame::visit() for each field
    template <class T>
    void operator()(const T& value, const frame::Term& term) {
        if constexpr (!std::is_same_v<T, Time>) {
            row_.numbers.clear();
            row_(value, term);
            constexpr bool whole = std::is_integral_v<T> || std::is_enum_v<T>;
            put(term, whole ? hdf5::Numbers::whole : hdf5::Numbers::real);
        }
    }
    void each(const char* name, const std::vector<frame::FingerFrame>& fingers, const char*) {
        each_of(head_.fingers, name, fingers);
    }
    void each(const char* name, const std::vector<frame::TurnFrame>& turns, const char*) {
        each_of(turning_, name, turns);
    }
    void each(const char* name, const std::vector<frame::JointFrame>& joints, const char*) {
        each_of(head_.joints, name, joints);
    }
    void changed(const char* name, const std::vector<frame::BodyFrame>& bodies,
                 const std::vector<uint16_t>&, const char*) {
        each_of(head_.bodies, name, bodies);
    }
    /// Writes each list of variable length to a table, which is created when its first item
    /// arrives.
    template <class T>
    void each(const char* name, const std::vector<T>& items, const char* meaning) {
        for (const T& item : items) {
            row_.numbers.clear();
            T::visit(item, row_);
            auto found = lists_.find(name);
            if (found == lists_.end()) {
                ListColumns columns;
                T::visit(item, columns);
                const bool of_contacts = std::is_same_v<T, frame::ContactFrame>;
                found = lists_
                            .try_emplace(name, acquisition_,
                                         of_contacts ? name : "task_" + std::string(name), meaning,
                                         columns.columns)
                            .first;
            }
            found->second.add(times_.back(), row_.numbers);
        }
    }

  private:
    template <class T>
    void each_of(const std::vector<std::string>& names, const char* list,
                 const std::vector<T>& items) {
        list_ = list;
        for (size_t i = 0; i < items.size(); ++i) {
            item_ = &names[i];
            T::visit(items[i], *this);
        }
        list_ = nullptr;
    }
    /// Appends the current row to the next series.
    void put(const frame::Term& term, hdf5::Numbers numbers) {
        if (next_ == series_.size()) {
            const size_t columns = row_.numbers.size();
            const bool spatial = columns == 3 && term.unit == std::string("m");
            series_.emplace_back(acquisition_, list_ ? *item_ + "_" + term.name : term.name,
                                 columns, term.unit, describe(term, columns),
                                 spatial ? reference_frame(term.frame) : "", numbers);
        }
        series_[next_++].add(row_.numbers.data());
    }
    static std::string reference_frame(const std::string& frame) {
        if (frame == "D") {
            return "Device: its own axes, from its own origin, whose pose in the world is in "
                   "general/devices and in the rig in the session's folder.";
        }
        return "World: x right, y away from the person, z up; origin on the table top.";
    }
    std::string describe(const frame::Term& term, size_t columns) const {
        const std::string name = term.name;
        std::string words = list_ ? *item_ + ": " : "";
        words += words_of(term);
        if (columns == 4) words += " Columns: w, x, y, z.";
        const std::string codes = codes_of(name, head_);
        if (!codes.empty()) words += " " + codes + ".";
        const std::string field = list_ ? name + " of " + list_ : name;
        if (std::find(not_recorded_.begin(), not_recorded_.end(), field) != not_recorded_.end())
            words +=
                " The version that recorded this session did not record this quantity: the values "
                "are defaults.";
        return words;
    }

    hid_t acquisition_;
    const LogHead& head_;
    std::vector<std::string> not_recorded_;
    std::vector<std::string> turning_;
    const char* list_ = nullptr;         // the list being visited
    const std::string* item_ = nullptr;  // name of the list item being visited
    std::vector<Series> series_;
    size_t next_ = 0;
    std::vector<double> times_;
    bool regular_ = true;
    std::map<std::string, ListTable> lists_;
    FrameRow row_;
};

/// Whether a column contains counts or indices.
bool is_whole(const std::string& column) {
    return column == "trial" || column == "attempt" || column.ends_with("_num") ||
           column == "trial_num_in_block";
}

Id write_column(hid_t group, const std::string& name, const Table& table, size_t c) {
    std::vector<double> numbers;
    std::vector<std::string> texts;
    for (const auto& row : table.rows) {
        const double* const number = std::get_if<double>(&row[c]);
        if (number != nullptr) numbers.push_back(*number);
        texts.push_back(number != nullptr ? to_csv(row[c]) : std::get<std::string>(row[c]));
    }
    if (numbers.size() < table.rows.size()) return write_dataset(group, name, texts);
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!is_whole(name) || !std::all_of(numbers.begin(), numbers.end(), finite))
        return write_dataset(group, name, numbers);
    return write_dataset(group, name, std::vector<int64_t>(numbers.begin(), numbers.end()));
}

/// Writes a table as a DynamicTable (or TimeIntervals); a column is numeric if all of its cells are
/// numbers.
void write_dynamic_table(hid_t parent, const std::string& name, const Table& table,
                         const std::string& type, const std::string& space,
                         const std::string& description) {
    const Id group = create_group(parent, name);
    mark(group, type, space);
    write_attribute(group, "description", description);
    std::vector<std::string> names;
    std::set<std::string> taken(kReservedColumns.begin(), kReservedColumns.end());
    for (const Table::Column& column : table.columns) {
        if (!taken.insert(column.name).second) {
            throw Error(fmt::format("the table of {} cannot have a column '{}': the name is taken",
                                    name, column.name),
                        "Rename whatever has this name in the experiment.");
        }
        names.push_back(column.name);
    }
    write_attribute(group, "colnames", names);
    std::vector<int64_t> ids;
    for (size_t i = 0; i < table.rows.size(); ++i) ids.push_back(static_cast<int64_t>(i));
    const Id id = write_dataset(group, "id", ids);
    mark(id, "ElementIdentifiers", "hdmf-common");
    for (size_t c = 0; c < table.columns.size(); ++c) {
        const Id column = write_column(group, names[c], table, c);
        mark(column, "VectorData", "hdmf-common");
        write_attribute(column, "description", table.columns[c].in_words());
    }
}

/// Lists the fingers, bodies and joints, so that readers of the file do not need the log as well.
Table items_of(const LogHead& head) {
    Table out{
        {{"list", "fingers, turns (fingers whose devices measure orientation), bodies, joints"},
         {"name", "its name"}},
        {}};
    const auto add = [&](const std::string& list, const std::vector<std::string>& names) {
        for (const std::string& name : names) out.rows.push_back({list, name});
    };
    add("fingers", head.fingers);
    add("turns", head.turning_fingers());
    add("bodies", head.bodies);
    add("joints", head.joints);
    return out;
}

/// Writes what is known about the study.
void write_study(hid_t general, const Study& study) {
    if (!study.experimenters.empty()) write_dataset(general, "experimenter", study.experimenters);
    if (!study.institution.empty()) write_dataset(general, "institution", study.institution);
    if (!study.lab.empty()) write_dataset(general, "lab", study.lab);
    if (!study.keywords.empty()) write_dataset(general, "keywords", study.keywords);
}

void write_general(hid_t file, const SessionInfo& info, const std::string& session) {
    const Id general = create_group(file, "general");
    write_dataset(general, "session_id", session);
    write_dataset(general, "experiment_description", info.title);
    write_study(general, info.study);
    std::string notes;
    for (const std::string& note : info.notes) notes += note + "\n";
    if (info.convergence) notes += info.convergence->describe() + "\n";
    if (!notes.empty()) write_dataset(general, "notes", notes);
    const Id subject = create_group(general, "subject");
    mark(subject, "Subject");
    write_dataset(subject, "subject_id",
                  info.participant.id.empty() ? "unknown" : info.participant.id);
    write_dataset(subject, "description", info.moved_by.describe());
    // only a person has a species
    if (info.moved_by.person()) write_dataset(subject, "species", "Homo sapiens");
    write_dataset(subject, "sex", info.participant.sex.empty() ? "U" : info.participant.sex);
    if (!info.participant.age.empty()) {
        const Id age = write_dataset(subject, "age", "P" + info.participant.age + "Y");
        write_attribute(age, "reference", "birth");
    }
    const Id devices = create_group(general, "devices");
    for (const DeviceRecord& record : info.devices) {
        const Id device = create_group(devices, record.finger);
        mark(device, "Device");
        write_attribute(device, "description", record.model);
    }
}

void write_head(hid_t file, const SessionInfo& info) {
    mark(file, "NWBFile");
    write_attribute(file, "nwb_version", "2.7.0");
    write_dataset(file, "identifier", new_uuid());
    write_dataset(file, "session_description",
                  info.title.empty() ? "Dihaptic session" : info.title);
    write_dataset(file, "session_start_time", info.started);
    write_dataset(file, "timestamps_reference_time", info.started);
    write_dataset(file, "file_create_date", std::vector<std::string>{iso_now()});
}

/// Writes the whole file, under any name.
void write_file(const std::string& name, const std::string& session, RawLogReader& log,
                const NwbContent& content, const std::function<void(double)>& progress) {
    Id file = hdf5::create_file(name);
    {
        write_head(file, content.info);
        for (const char* group : {"analysis", "processing"}) create_group(file, group);
        const Id stimulus = create_group(file, "stimulus");
        for (const char* group : {"presentation", "templates"}) create_group(stimulus, group);
        write_general(file, content.info, session);

        const Id acquisition = create_group(file, "acquisition");
        FrameExporter exporter(acquisition, log);
        while (const frame::Frame* frame = log.next()) {
            exporter.add(*frame);
            if (progress && frame->sequence % 1000 == 0) progress(0.99 * log.share());
        }
        exporter.close();

        const Id intervals = create_group(file, "intervals");
        write_dynamic_table(intervals, "trials", content.trials, "TimeIntervals", "core",
                            "The trials, in order.");
        write_dynamic_table(intervals, "phases", content.phases, "TimeIntervals", "core",
                            "The phases of each trial.");
        write_dynamic_table(
            intervals, "events", content.events, "TimeIntervals", "core",
            "Events, and when they were seen. Each stops at the moment when it starts.");
        const Id scratch = create_group(file, "scratch");
        write_dynamic_table(scratch, "settings", content.settings, "DynamicTable", "hdmf-common",
                            "Every setting of the session, with its origin.");
        if (const Table items = items_of(log.head()); !items.rows.empty()) {
            write_dynamic_table(scratch, "items", items, "DynamicTable", "hdmf-common",
                                "The named items in acquisition, in the order of their indices.");
        }
        hdf5::flush(file);
    }
    hdf5::close(std::move(file));
}

/// Frees the disk space of a file that could not be written, because HDF5 may keep the file open
/// even after it is removed.
struct Emptied {
    std::string name;
    ~Emptied() {
        std::error_code gone;
        std::filesystem::resize_file(name, 0, gone);
    }
};

}  // namespace

void write_nwb(const SessionFolder& folder, const NwbContent& content,
               const std::function<void(double)>& progress) {
    RawLogReader log(folder.raw_log());
    remove_dead_parts(folder.nwb());
    Output output(folder.nwb());
    const Emptied emptied{output.path()};
    const auto failed = [&](const std::string& why, int error) {
        return Error({folder.nwb(), 0}, "", "cannot be written: " + why,
                     "raw.log has all data: " + make_room(error) + ", then run: dihaptic recover " +
                         shell_file(folder.path()));
    };
    try {
        const std::string session =
            std::filesystem::path(folder.path()).lexically_normal().filename();
        write_file(output.path(), session, log, content, progress);
    } catch (const hdf5::WriteFailure& e) {
        throw failed(e.what(), e.error);
    }
    try {
        sync_to_disk(output.path());  // some file systems report only now that they are full
    } catch (const Error& e) {
        throw failed(e.problems().front().what, 0);
    }
    output.keep();
    if (progress) progress(1);
}

int64_t ticks_in_nwb(const SessionFolder& folder) {
    std::error_code unreadable;  // ignored; HDF5 would wait for a pipe, hence this check
    if (!std::filesystem::is_regular_file(folder.nwb(), unreadable)) return -1;
    return hdf5::rows_of(folder.nwb(), "acquisition/status/data");
}

}  // namespace dihaptic::recording
