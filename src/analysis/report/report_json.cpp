#include "analysis/report/report_json.h"

#include <nlohmann/json.hpp>

#include "recording/session.h"

namespace dihaptic::analysis {
namespace {

using ReportJson = nlohmann::json;

ReportJson texts_of(const std::vector<Problem>& problems) {
    ReportJson out = ReportJson::array();
    for (const Problem& problem : problems) out.push_back(problem.text());
    return out;
}

ReportJson described(const Table& table) {
    ReportJson columns = ReportJson::array();
    for (const Table::Column& column : table.columns) columns.push_back(column.name);
    ReportJson rows = ReportJson::array();
    for (const auto& row : table.rows) {
        ReportJson cells = ReportJson::array();
        for (const Table::Cell& cell : row) cells.push_back(to_text(cell));
        rows.push_back(std::move(cells));
    }
    return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

ReportJson described(const ReportSample& of) {
    return {{"title", of.title},
            {"mover", of.moved_by.name()},
            {"population", of.moved_by.population},
            {"who", of.moved_by.describe()},
            {"not_measured", of.not_measured},
            {"contact", of.contact},
            {"perturbations", described(of.perturbations)},
            {"note", of.note},
            {"folders", of.folders}};
}

}  // namespace

std::string report_json(const ReportResult& result, const std::string& command) {
    ReportJson samples = ReportJson::array();
    for (const ReportSample& one : result.samples) samples.push_back(described(one));
    const ReportJson out{{"command", command},
                         {"program", recording::program_version()},
                         {"paths", result.paths},
                         {"out", result.out},
                         {"left_out", result.left_out},
                         {"changed", texts_of(result.changed)},
                         {"unwritten", texts_of(result.unwritten)},
                         {"faults", result.log},
                         {"samples", std::move(samples)}};
    // a file name may be invalid UTF-8; invalid bytes become replacement characters
    return out.dump(-1, ' ', false, ReportJson::error_handler_t::replace);
}

}  // namespace dihaptic::analysis
