#include "analysis/dictionary.h"

#include <map>

#include "analysis/measures/measures.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "base/regular_file.h"
#include "base/unit.h"
#include "rows/correction_row.h"
#include "rows/lift_row.h"
#include "task/plan/custom_measures.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis {
namespace {

class Dictionary {
  public:
    Dictionary(const recording::SessionFolder& session, const std::string& file) {
        add_all(recording::kMovedByColumns);
        if (file == "lifts.csv") add_all(list_figures(rows::LiftRow{}).columns);
        if (file == "corrections.csv") add_all(list_figures(rows::CorrectionRow{}).columns);
        if (file == "trials.csv") add_trials(session);
    }

    Table::Column of(const std::string& name) const {
        const auto found = columns_.find(name);
        return found == columns_.end() ? Table::Column{name, ""} : found->second;
    }

  private:
    void add_trials(const recording::SessionFolder& session) {
        add_all(has_trials(session) ? trial_columns()
                                    : list_figures(rows::PlainTrialRow{}).columns);
        for (const NumberColumn& column : columns_of_numbers(session.read_info())) add(column);
        if (!is_there(session.file("task.yaml"))) return;
        const task::Task task = read_frozen_task(session.file("task.yaml"));
        add_all(task::own_columns(task));
        add_all(measure_columns_of(task));
        for (const task::AskSpec& ask : task::questions_of(task)) {
            if (!ask.question.empty()) columns_[ask.name].description = ask.question;
        }
    }

    void add(const Table::Column& column) {
        Table::Column& known = columns_[column.name];
        known = column;
        const NameInUnit unit = split_unit(column.name);
        if (known.unit.empty() && unit.name != column.name)
            known.unit = column.name.substr(unit.name.size() + 1);
    }
    template <class Columns>
    void add_all(const Columns& columns) {
        for (const Table::Column& column : columns) add(column);
    }

    std::map<std::string, Table::Column> columns_;
};

}  // namespace

std::vector<Table::Column> described_columns(const recording::SessionFolder& session,
                                             const std::string& file,
                                             const std::vector<std::string>& names) {
    const Dictionary dictionary(session, file);
    std::vector<Table::Column> out;
    for (const std::string& name : names) out.push_back(dictionary.of(name));
    return out;
}

}  // namespace dihaptic::analysis
