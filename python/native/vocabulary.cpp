#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <tuple>

#include "analysis/curves.h"
#include "analysis/episodes.h"
#include "analysis/events.h"
#include "analysis/lifts.h"
#include "analysis/session_report.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "base/installed.h"
#include "base/node.h"
#include "base/palette.h"
#include "base/unit.h"
#include "frame/frame.h"
#include "frame_values.h"
#include "parts.h"
#include "plans.h"
#include "recording/raw_log.h"
#include "recording/schema.h"
#include "recording/seal.h"
#include "recording/session.h"
#include "rows/correction_row.h"
#include "session/check.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

/// List, name, type, unit, frame, meaning.
using QuantityRow =
    std::tuple<std::string, std::string, std::string, std::string, std::string, std::string>;

/// Lists the quantities of a Frame as its visit() describes them.
class QuantityLister {
  public:
    template <class T>
    void operator()(const T&, const frame::Term& term) {
        rows.emplace_back(list_, term.name, recording::type_name<T>(), term.unit, term.frame,
                          term.meaning);
    }
    template <class T>
    void each(const char* name, const std::vector<T>&, const char*) {
        list_ = name;
        const T item{};
        T::visit(item, *this);
        list_ = "";
    }
    template <class T>
    void changed(const char* name, const std::vector<T>& items, const std::vector<uint16_t>&,
                 const char* meaning) {
        each(name, items, meaning);
    }
    std::vector<QuantityRow> rows;

  private:
    const char* list_ = "";
};

std::vector<QuantityRow> quantities() {
    QuantityLister lister;
    const frame::Frame frame;
    frame::Frame::visit(frame, lister);
    return lister.rows;
}

/// The name and the meaning of each column of a table.
template <class Columns>
py::list meanings(const Columns& columns) {
    py::list out;
    for (const Table::Column& column : columns)
        out.append(py::make_tuple(column.name, column.description));
    return out;
}

py::dict table_columns() {
    py::dict out;
    out["trials.csv"] = meanings(analysis::trial_columns());
    out["phases.csv"] = meanings(list_figures(rows::PhaseRow{}).columns);
    out["events.csv"] = meanings(list_figures(rows::EventRow{}).columns);
    out["episodes.csv"] = meanings(list_figures(rows::EpisodeRow{}).columns);
    out["lifts.csv"] = meanings(list_figures(rows::LiftRow{}).columns);
    out["corrections.csv"] = meanings(list_figures(rows::CorrectionRow{}).columns);
    return out;
}

/// The usual notation, such as "N/s", of each unit at the end of a name, such as N_s.
py::dict unit_symbols() {
    py::dict out;
    for (int i = 1; i <= static_cast<int>(Quantity::angular_speed); ++i) {
        const auto quantity = static_cast<Quantity>(i);
        for (const Unit& unit : units(quantity)) {
            std::string symbol(unit.suffix);
            std::replace(symbol.begin(), symbol.end(), '_', '/');
            const py::str suffix{std::string(unit.suffix)};
            // of two kinds with the same suffix, the first counts, as in split_unit()
            if (!out.contains(suffix))
                out[suffix] = unit.si == 1 ? std::string(si_symbol(quantity)) : symbol;
        }
    }
    out["mm2"] = "mm^2";  // of a measure: no key of a file is an area
    // of curves (analysis/curves.h)
    for (const QuantityRow& row : quantities()) {
        const std::string& symbol = std::get<3>(row);
        const py::str suffix(analysis::column_name("", symbol).substr(symbol == "1" ? 0 : 1));
        if (symbol != "1" && !out.contains(suffix)) out[suffix] = symbol;
    }
    return out;
}

/// dihaptic._text.Plain, a word without quotes in a file.
py::object plain_type() {
    return py::module_::import("dihaptic._text").attr("Plain");
}

/// A document as dictionaries, lists and texts.
py::object to_python(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return py::none();
        case Node::Kind::scalar:
            return node.plain ? plain_type()(node.scalar) : py::object(py::str(node.scalar));
        case Node::Kind::sequence: {
            py::list out;
            for (const Node& item : node.items) out.append(to_python(item));
            return out;
        }
        case Node::Kind::mapping: {
            py::dict out;
            for (const Node::Entry& entry : node.entries)
                out[py::str(entry.key)] = to_python(entry.value);
            return out;
        }
    }
    return py::none();
}

Node to_node(const py::handle& value) {
    if (value.is_none()) return {};
    if (py::isinstance<py::dict>(value)) {
        Node out = Node::mapping();
        for (const auto& [key, item] : py::cast<py::dict>(value))
            out.set(py::str(key), to_node(item));
        return out;
    }
    if (py::isinstance<py::list>(value)) {
        Node out;
        out.kind = Node::Kind::sequence;
        for (const py::handle& item : py::cast<py::list>(value)) out.items.push_back(to_node(item));
        return out;
    }
    if (py::isinstance<py::bool_>(value))
        return Node::plain_word(py::cast<bool>(value) ? "yes" : "no");
    if (py::isinstance<py::float_>(value)) return Node::number(py::cast<double>(value));
    const std::string word = py::str(value);
    const bool text = py::isinstance<py::str>(value) && !py::isinstance(value, plain_type());
    return text ? Node::of(word) : Node::plain_word(word);
}

using ProblemRow = std::tuple<std::string, std::string, int, std::string, std::string, std::string,
                              std::vector<std::pair<std::string, std::string>>>;

/// The findings of `dihaptic check` in a file, with the words allowed there.
std::vector<ProblemRow> check_file(const std::string& file, const std::string& rig) {
    Diagnostics diagnostics;
    try {
        session::check_file(file, diagnostics, rig);
    } catch (const Error& error) {
        diagnostics.add(error.problems());
    }
    std::vector<ProblemRow> out;
    for (const Problem& p : diagnostics.problems()) {
        out.emplace_back(p.severity == Severity::error ? "error" : "warning", p.place.file,
                         p.place.line, p.key, p.what, p.remedy,
                         std::vector<std::pair<std::string, std::string>>{});
        for (const Choice& choice : p.choices)
            std::get<6>(out.back()).emplace_back(choice.word, choice.what);
    }
    return out;
}

bool on_real_devices(const std::string& file, const std::string& rig) {
    return session::on_real_devices(request_of(file, rig, {}, 1));
}

using Lines = std::vector<std::pair<std::string, int>>;

void add_lines(const Node& node, const std::string& path, Lines& out) {
    if (!path.empty()) out.emplace_back(path, node.place.line);
    for (size_t i = 0; i < node.items.size(); ++i)
        add_lines(node.items[i], fmt::format("{}[{}]", path, i), out);
    for (const Node::Entry& entry : node.entries)
        add_lines(entry.value, path.empty() ? entry.key : path + "." + entry.key, out);
}

/// Each value of a file, by its path, such as bodies[1].mass_g, and its line.
Lines lines_of(const std::string& file) {
    Lines out;
    add_lines(read_yaml(file), "", out);
    return out;
}

/// A quantity in a log, tick by tick, with all its bits.
py::list log_values(const std::string& file, const std::string& list, size_t item,
                    const std::string& name) {
    recording::RawLogReader log(file);
    FrameValue value(list, item, name);
    py::list out;
    while (const frame::Frame* frame = log.next()) out.append(value.of(*frame));
    return out;
}

/// The program's facts about sessions for the package's readers, which need nothing else from it
/// (python/write_facts.py).
py::dict facts() {
    py::dict colours;
    colours["grip_force"] = palette::kGrip;
    colours["load_force"] = palette::kLoad;
    py::dict out;
    out["version"] = recording::program_version();
    out["quantities"] = quantities();
    out["columns"] = table_columns();
    out["units"] = unit_symbols();
    out["colours"] = colours;
    // a word that looks like a number there is a name
    out["text_columns"] = std::vector<std::string>{"ppid", "id", "group"};
    out["tables_from_log"] = recording::tables_from_log();
    out["other_tables"] = recording::other_tables();
    return out;
}

}  // namespace

void add_vocabulary(py::module_& m) {
    m.def("facts", &facts);
    m.def("read_yaml", [](const std::string& file) { return to_python(read_yaml(file)); });
    m.def("write_yaml", [](const py::handle& value) { return to_yaml(to_node(value)); });
    m.def("check_yaml",
          [](const std::string& text, const std::string& file) { parse_yaml(text, file); });
    m.def("check_file", &check_file);
    m.def("on_real_devices", &on_real_devices);
    m.def("lines_of", &lines_of);
    m.def("log_values", &log_values);
    m.def("program", [] { return in_or_above_program({"dihaptic", "bin/dihaptic"}); });
    m.def("kept", &kept);
}

}  // namespace dihaptic::python
