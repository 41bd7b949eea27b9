#include "analysis/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "analysis/ended.h"
#include "base/choices.h"
#include "base/number.h"
#include "base/output.h"
#include "base/table.h"
#include "recording/frame_row.h"
#include "recording/log_health.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {
namespace {

constexpr const char* kTrial = "trial";

/// A recorded quantity, with one number per tick or one for each component.
struct Curve {
    std::string name;
    std::string unit;   ///< unit as usually written
    std::string parts;  ///< "xyz" for a vector, "wxyz" for a rotation, "" for a number
    size_t first = 0;   ///< index of the quantity's first number in a TickRow

    size_t width() const { return std::max<size_t>(1, parts.size()); }
};

template <class T>
std::string parts_of() {
    if constexpr (std::is_same_v<T, Vec3>) return "xyz";
    if constexpr (std::is_same_v<T, Quat>) return "wxyz";
    return "";
}

/// Lists the quantities recorded in a tick, in the order of a TickRow, and the lists that have no
/// curves.
class CurveLister {
  public:
    explicit CurveLister(const recording::LogHead& head)
        : head_(head), turning_(head.turning_fingers()) {
        frame::Frame frame;
        frame.fingers.resize(head.fingers.size());
        frame.turns.resize(turning_.size());
        frame.bodies.resize(head.bodies.size());
        frame.joints.resize(head.joints.size());
        frame::Frame::visit(frame, *this);
    }
    std::vector<Curve> curves;
    std::vector<std::string> lists;

    // called by visit()
    template <class T>
    void operator()(const T&, const frame::Term& term) {
        if constexpr (!std::is_same_v<T, Time>) {
            const Curve& last = curves.empty() ? Curve{} : curves.back();
            const size_t first = curves.empty() ? 0 : last.first + last.width();
            curves.push_back({item_ + term.name, term.unit, parts_of<T>(), first});
        }
    }
    void each(const char*, const std::vector<frame::FingerFrame>& fingers, const char*) {
        each_of(head_.fingers, fingers);
    }
    void each(const char*, const std::vector<frame::TurnFrame>& turns, const char*) {
        each_of(turning_, turns);
    }
    void each(const char*, const std::vector<frame::JointFrame>& joints, const char*) {
        each_of(head_.joints, joints);
    }
    void changed(const char*, const std::vector<frame::BodyFrame>& bodies,
                 const std::vector<uint16_t>&, const char*) {
        each_of(head_.bodies, bodies);
    }
    template <class T>
    void each(const char* list, const std::vector<T>&, const char*) {
        lists.emplace_back(list);
    }

  private:
    template <class T>
    void each_of(const std::vector<std::string>& names, const std::vector<T>& items) {
        for (size_t i = 0; i < items.size(); ++i) {
            item_ = names[i] + ".";
            T::visit(items[i], *this);
        }
        item_.clear();
    }

    const recording::LogHead& head_;
    std::vector<std::string> turning_;
    std::string item_;
};

/// All the numbers of a tick that belong to curves.
class TickRow {
  public:
    const std::vector<double>& of(const frame::Frame& frame) {
        row_.numbers.clear();
        frame::Frame::visit(frame, *this);
        return row_.numbers;
    }

    // called by visit()
    template <class T>
    void operator()(const T& value, const frame::Term& term) {
        if constexpr (!std::is_same_v<T, Time>) row_(value, term);
    }
    template <class T>
    void each(const char*, const std::vector<T>& items, const char*) {
        constexpr bool named = std::is_same_v<T, frame::FingerFrame> ||
                               std::is_same_v<T, frame::TurnFrame> ||
                               std::is_same_v<T, frame::JointFrame>;
        if constexpr (named) {
            for (const T& item : items) T::visit(item, *this);
        }
    }
    void changed(const char*, const std::vector<frame::BodyFrame>& bodies,
                 const std::vector<uint16_t>&, const char*) {
        for (const frame::BodyFrame& body : bodies) frame::BodyFrame::visit(body, *this);
    }

  private:
    recording::FrameRow row_;
};

struct Column {
    std::string name;
    size_t index = 0;  ///< index in a TickRow
};

/// A name that can be requested, and the columns it stands for.
struct Known {
    std::string asked;
    std::vector<Column> columns;
};

std::vector<Known> known_columns(const std::vector<Curve>& curves) {
    std::vector<Known> out;
    for (const Curve& curve : curves) {
        if (curve.parts.empty()) {
            out.push_back({curve.name, {{column_name(curve.name, curve.unit), curve.first}}});
            continue;
        }
        Known whole{curve.name, {}};
        for (size_t i = 0; i < curve.parts.size(); ++i) {
            const std::string name = curve.name + "." + curve.parts[i];
            whole.columns.push_back({column_name(name, curve.unit), curve.first + i});
            out.push_back({name, {whole.columns.back()}});
        }
        out.push_back(whole);
    }
    return out;
}

std::vector<Column> columns_of(const std::vector<std::string>& names, const CurveLister& lister,
                               const std::string& session) {
    const std::vector<Known> known = known_columns(lister.curves);
    Diagnostics diagnostics;
    std::vector<Column> out;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(known, name, &Known::asked);
        if (found != known.end()) {
            out.insert(out.end(), found->columns.begin(), found->columns.end());
        } else if (std::ranges::find(lister.lists, name) != lister.lists.end()) {
            diagnostics.error({session, 0}, name, "is a list, which has no curve",
                              "session.nwb contains it as a table.");
        } else {
            std::vector<std::string> candidates;
            for (const Known& each : known) candidates.push_back(each.asked);
            diagnostics.error({session, 0}, name, "is not recorded",
                              meant(name, candidates, diagnostics));
        }
    }
    diagnostics.throw_if_errors();
    // each column occurs once; the trial column is always written, and comes first
    std::vector<Column> once;
    for (const Column& column : out) {
        const bool there = std::ranges::find(once, column.name, &Column::name) != once.end();
        if (!there && column.name != kTrial) once.push_back(column);
    }
    return once;
}

/// Appends a cell with nine digits, which is more than session.nwb has, or with all digits for
/// whole numbers.
void add_cell(std::string& line, double value) {
    line += ',';
    if (std::isnan(value)) return;
    constexpr double kMostWhole = 1e15;
    if (std::abs(value) < kMostWhole && value == std::floor(value)) {
        line += number_text(static_cast<int64_t>(value));
    } else {
        line += number_text(value, 9);
    }
}

void write(std::ofstream& out, recording::RawLogReader& log, const std::vector<Column>& columns,
           const std::function<void(double)>& progress) {
    std::string line(kBeginOfCurves);
    for (const Column& column : columns) line += "," + to_csv(Table::Cell(column.name));
    out << line << '\n';
    TickRow row;
    int64_t ticks = 0;
    while (const frame::Frame* frame = log.next()) {
        const std::vector<double>& numbers = row.of(*frame);
        line = number_text(seconds(frame->time), 12);
        add_cell(line, frame->trial);
        for (const Column& column : columns) add_cell(line, numbers[column.index]);
        out << line << '\n';
        if (++ticks % 5000 == 0 && progress) progress(log.share());
    }
}

}  // namespace

std::string column_name(const std::string& quantity, const std::string& unit) {
    if (unit == "1") return quantity;
    std::string suffix;
    for (const char c : unit) {
        if (c != '*' && c != '^') suffix += c == '/' ? '_' : c;
    }
    return quantity + "_" + suffix;
}

std::vector<std::string> export_curves(const recording::SessionFolder& session,
                                       const std::vector<std::string>& names,
                                       const std::string& file,
                                       const std::function<void(double)>& progress) {
    const recording::SessionInfo info = session.read_info();
    check_ended(session, info);
    recording::RawLogReader log(session.raw_log());
    session.check_log(info, log.head());
    const CurveLister lister(log.head());
    const std::vector<Column> columns = columns_of(names, lister, session.path());
    Output output(file);
    std::ofstream out(output.path());
    write(out, log, columns, progress);
    out.close();
    if (!out) {
        throw Error({file, 0}, "", "cannot be written",
                    "Check the folder's permissions and the disk's space.");
    }
    output.keep();
    if (!log.health().damaged(info.ticks)) return {};
    return recording::describe(log.health(), info.ticks, info.planned());
}

}  // namespace dihaptic::analysis
