#include "task/plan/trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "base/number.h"
#include "base/text_file.h"
#include "task/plan/factors.h"
#include "task/plan/lookup.h"
#include "task/plan/streams.h"

namespace dihaptic::task {
namespace {

/// Fisher-Yates shuffle.
void shuffle(std::vector<int>& list, Random& random) {
    for (size_t i = list.size(); i > 1; --i) {
        const auto j = static_cast<size_t>(random.uniform(0, static_cast<double>(i)));
        std::swap(list[i - 1], list[std::min(j, i - 1)]);
    }
}

/// Returns a row of Williams's design: (0, n-1, 1, n-2, ...) + row, modulo n. For odd n, the rows
/// from n on are mirrored.
std::vector<int> williams_row(int n, int row) {
    std::vector<int> out;
    const bool mirrored = n % 2 == 1 && row % (2 * n) >= n;
    for (int i = 0; i < n; ++i) {
        const int zigzag = i % 2 == 0 ? i / 2 : n - 1 - i / 2;
        out.push_back((zigzag + row) % n);
    }
    if (mirrored) std::reverse(out.begin(), out.end());
    return out;
}

std::vector<int> permutation(int n, int64_t number) {
    std::vector<int> left(static_cast<size_t>(n));
    std::iota(left.begin(), left.end(), 0);
    std::vector<int64_t> factorial(left.size() + 1, 1);
    for (size_t i = 1; i < factorial.size(); ++i)
        factorial[i] = factorial[i - 1] * static_cast<int64_t>(i);
    number %= factorial.back();
    std::vector<int> out;
    for (size_t i = left.size(); i > 0; --i) {
        const auto pick = static_cast<std::ptrdiff_t>(number / factorial[i - 1]);
        number %= factorial[i - 1];
        out.push_back(left[static_cast<size_t>(pick)]);
        left.erase(left.begin() + pick);
    }
    return out;
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Finds things by name quickly, since lists can have thousands of trials.
class Index {
  public:
    template <class Thing>
    explicit Index(const std::vector<Thing>& things) {
        for (size_t i = 0; i < things.size(); ++i)
            by_name_.emplace(things[i].name, static_cast<int>(i));
    }
    int operator()(const std::string& name) const {
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? -1 : found->second;
    }

  private:
    std::unordered_map<std::string, int> by_name_;
};

/// Splits a cell of the column `perturbation` into names.
std::vector<std::string> names_in(const std::string& cell) {
    std::vector<std::string> out;
    if (cell.empty()) return out;
    size_t from = 0;
    for (size_t to = cell.find(kBetweenNames); to != std::string::npos;
         to = cell.find(kBetweenNames, from)) {
        out.push_back(cell.substr(from, to - from));
        from = to + kBetweenNames.size();
    }
    out.push_back(cell.substr(from));
    return out;
}

/// Returns the largest number of trials that each procedure can request, interleaved so that
/// participants cannot tell which procedure comes next.
std::vector<Trial> procedure_trials(const Task& task, const Block& block, Trial trial,
                                    Random& random) {
    std::vector<int> turns;
    for (const int i : block.procedures.indices)
        turns.insert(turns.end(),
                     static_cast<size_t>(task.procedures[static_cast<size_t>(i)].trials), i);
    shuffle(turns, random);
    std::vector<Trial> out;
    for (const int i : turns) {
        const ProcedureSpec& procedure = task.procedures[static_cast<size_t>(i)];
        trial.procedure = i;
        trial.perturb = procedure.perturb.indices;
        trial.share = procedure.level.empty() ? std::numeric_limits<double>::quiet_NaN() : 1;
        out.push_back(trial);
    }
    return out;
}

/// Returns the indices of the block's conditions: all of the task's conditions if the block lists
/// none, and the unnamed condition if the task has none.
std::vector<int> conditions_of(const Task& task, const Block& block) {
    std::vector<int> out = block.conditions.indices;
    if (out.empty()) {
        out.resize(std::max<size_t>(1, task.conditions.size()));
        std::iota(out.begin(), out.end(), 0);
    }
    return out;
}

/// Assigns conditions to trials in the block's order, repeating this order as needed.
void deal_conditions(const std::vector<int>& conditions, Order order, int number, Random& random,
                     std::vector<Trial>& trials) {
    const int n = static_cast<int>(conditions.size());
    for (size_t i = 0; i < trials.size();) {
        for (const int k : ordered(n, order, number, random)) {
            if (i == trials.size()) break;
            trials[i++].condition = conditions[static_cast<size_t>(k)];
        }
    }
}

/// Returns trials in which every condition occurs once in each repeat.
std::vector<Trial> repeated_trials(const std::vector<int>& conditions, const Block& block,
                                   Trial trial, int number, Random& random) {
    const int n = static_cast<int>(conditions.size());
    std::vector<Trial> out;
    for (int repeat = 0; repeat < block.repeats; ++repeat) {
        // rows of a Latin square continue from one repeat to the next
        const int row = block.order == Order::latin_square ? number + repeat : number;
        for (const int i : ordered(n, block.order, row, random)) {
            trial.condition = conditions[static_cast<size_t>(i)];
            out.push_back(trial);
        }
    }
    return out;
}

/// Inserts trials at random positions. Each inserted trial follows another trial, so it is never
/// the first. To keep a gap between inserted trials, positions are drawn without the gap and then
/// moved apart.
void insert_trials(const Insert& insert, Random& random, std::vector<Trial>& trials) {
    const int gaps = (insert.count - 1) * (insert.gap - 1);
    const auto places = ordered(static_cast<int>(trials.size()) - gaps, Order::shuffled, 0, random);
    std::vector<int> which;
    for (int k = 0; k < insert.count; ++k)
        which.push_back(places[static_cast<size_t>(k) % places.size()]);
    std::sort(which.rbegin(), which.rend());
    for (int k = 0; k < insert.count; ++k)
        which[static_cast<size_t>(k)] += (insert.count - 1 - k) * (insert.gap - 1);
    const std::vector<int>& conditions = insert.conditions.indices;
    size_t left = which.size();  // trials are inserted starting with the last
    for (const int i : which) {
        Trial extra = trials[static_cast<size_t>(i)];
        --left;
        if (!conditions.empty()) extra.condition = conditions[left % conditions.size()];
        extra.kind = insert.kind;
        extra.perturb = insert.perturb.indices;
        extra.procedure = -1;
        if (std::isnan(extra.share)) extra.share = 1;
        trials.insert(trials.begin() + i + 1, extra);
    }
}

/// Returns the trials of the block, in order. Conditions are shuffled with `own`, the participant's
/// stream, if this is set, and otherwise with the seed's stream. Positions of inserted trials
/// always use the seed's stream, so that all participants have the same kinds of trial at each
/// point of a learning curve.
std::vector<Trial> trials_of(const Task& task, const Block& block, int round, int number,
                             Random& random, std::optional<Random> own) {
    Trial trial;
    trial.round = round;
    trial.kind = block.kind;
    trial.perturb = block.perturb.indices;
    const std::vector<int> conditions = conditions_of(task, block);
    const auto deal = [&](Random& from) {
        if (block.procedures.empty())
            return repeated_trials(conditions, block, trial, number, from);
        std::vector<Trial> dealt = procedure_trials(task, block, trial, from);
        deal_conditions(conditions, block.order, number, from, dealt);
        return dealt;
    };
    std::vector<Trial> out = deal(random);  // needed even if `own` is used, to advance `random`
    if (own) out = deal(*own);
    for (size_t i = 0; i < out.size() && block.ramp > 0; ++i)
        out[i].share = std::min(1.0, static_cast<double>(i + 1) / block.ramp);
    for (const Insert& insert : block.insert) insert_trials(insert, random, out);
    for (size_t i = 0; i < out.size(); ++i) out[i].in_block = static_cast<int>(i) + 1;
    return out;
}

/// Returns the contents of a cell in the column `perturbation`.
std::string perturbations_cell(const Task& task, const std::vector<int>& perturb) {
    std::vector<std::string> names;
    for (const int i : perturb) names.push_back(task.perturbations[static_cast<size_t>(i)].name);
    return fmt::format("{}", fmt::join(names, kBetweenNames));
}

/// Returns the indices of the perturbations in a cell of the column `perturbation`, with -1 for an
/// unknown name. The name of a perturbation may itself contain " + ".
std::vector<int> read_perturbations(const Index& perturbations, const std::string& cell) {
    if (const int one = perturbations(cell); one >= 0) return {one};
    std::vector<int> out;
    for (const std::string& name : names_in(cell)) out.push_back(perturbations(name));
    return out;
}

template <class Thing>
std::string name_at(const std::vector<Thing>& things, int i) {
    return i >= 0 && i < static_cast<int>(things.size()) ? things[static_cast<size_t>(i)].name : "";
}

void draw_for(std::vector<Trial>& trials, const Task& task, int number, uint64_t seed) {
    std::vector<int> blocks;
    for (const Trial& trial : trials) blocks.push_back(trial.number);
    for (const DrawSpec& draw : task.draws) {
        const std::vector<double> values = drawn(draw, blocks, number, seed);
        for (size_t i = 0; i < trials.size(); ++i) trials[i].draws.push_back(values[i]);
    }
}

/// Appends the cells for own_columns().
void add_own_cells(const Task& task, const std::vector<Factor>& factors, const Trial& trial,
                   std::vector<Table::Cell>& row) {
    for (const Factor& factor : factors) {
        const std::vector<Condition>& owners = owners_of(task, factor.factor);
        const auto of =
            static_cast<size_t>(&owners == &task.rounds ? trial.round : trial.condition);
        const std::string level = of < owners.size() ? level_of(owners[of], factor.factor) : "";
        if (are_texts(factor.levels)) {
            row.emplace_back(level);
        } else {
            row.emplace_back(finite_number(level).value_or(kUnmeasured));
        }
    }
    for (size_t k = 0; k < task.draws.size(); ++k) {
        const std::vector<std::string>& values = task.draws[k].values();
        if (are_texts(values)) {
            row.emplace_back(values[static_cast<size_t>(trial.draws[k])]);
        } else {
            row.emplace_back(trial.draws[k]);
        }
    }
}

/// Reads the values of the draws from a row of a list. Throws bad(column) if the draw cannot have
/// the value.
template <class Bad>
std::vector<double> read_draws(const Task& task, const std::vector<std::string>& header,
                               const std::vector<std::string>& row, const Bad& bad) {
    std::vector<double> out;
    for (const DrawSpec& draw : task.draws) {
        const int column = index_of(header, draw.name);
        if (column < 0 || column >= static_cast<int>(row.size())) throw bad(draw.name.c_str());
        const std::string& cell = row[static_cast<size_t>(column)];
        const int text = index_of(draw.values(), cell);
        const auto number = finite_number(cell);
        if (are_texts(draw.values()) ? text < 0 : !number) throw bad(draw.name.c_str());
        out.push_back(are_texts(draw.values()) ? text : *number);
    }
    return out;
}

}  // namespace

bool names_perturbation(const std::string& cell, const std::string& name) {
    const std::vector<std::string> names = names_in(cell);
    return cell == name || std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<int> ordered(int n, Order order, int number, Random& random) {
    switch (order) {
        case Order::latin_square:
            return williams_row(n, std::max(0, number));
        case Order::counterbalanced:
            return permutation(n, std::max(0, number));
        case Order::sequential:
        case Order::shuffled:
            break;
    }
    std::vector<int> out(static_cast<size_t>(n));
    std::iota(out.begin(), out.end(), 0);
    if (order == Order::shuffled) shuffle(out, random);
    return out;
}

int orders_of(int n, Order order) {
    int out = 1;
    if (order == Order::latin_square && n > 1) out = n % 2 == 0 ? n : 2 * n;
    if (order == Order::counterbalanced) {
        for (int i = 2; i <= n; ++i) out *= i;
    }
    return out;
}

std::vector<NumberedOrder> numbered_orders(const Task& task) {
    std::vector<NumberedOrder> out;
    const int rounds = orders_of(static_cast<int>(task.rounds.size()), task.round_order);
    if (rounds > 1) out.push_back({"rounds", rounds});
    for (const Block& block : task.blocks) {
        const int n = static_cast<int>(conditions_of(task, block).size());
        const int orders = orders_of(n, block.order);
        // in repeats, each participant goes on with the next row of a Latin square
        if (orders > 1 && !(block.order == Order::latin_square && block.repeats % orders == 0))
            out.push_back({fmt::format("conditions of block {}", block.name), orders});
    }
    return out;
}

int participant_number(const std::string& id) {
    size_t digits = 0;
    while (digits < id.size() && digits < 8 &&
           std::isdigit(static_cast<unsigned char>(id[id.size() - 1 - digits])) != 0)
        ++digits;
    return digits == 0 ? -1 : *whole_number<int>(std::string_view(id).substr(id.size() - digits));
}

bool needs_number(const Task& task) {
    const auto by_number = [](Order order) {
        return order == Order::latin_square || order == Order::counterbalanced;
    };
    const auto is_number = [](const DrawSpec& draw) { return draw.participant; };
    return (by_number(task.round_order) && task.rounds.size() > 1) ||
           std::any_of(task.draws.begin(), task.draws.end(), is_number) ||
           std::any_of(task.blocks.begin(), task.blocks.end(),
                       [&](const Block& block) { return by_number(block.order); });
}

std::vector<Trial> make_trials(const Task& task, int number, uint64_t seed) {
    // participants are counted from 1, so the first participant gets row 0
    const int row = std::max(0, number - 1);
    Random rounds_random(seed, stream_of("rounds", number));
    std::vector<Trial> out;
    int block_number = 0;
    const auto add = [&](int round, Once once) {
        for (size_t b = 0; b < task.blocks.size(); ++b) {
            if (task.blocks[b].once != once) continue;
            // each block has its own random stream, so that changing one block does not affect the
            // others
            const std::string stream = fmt::format("trials of block {} in round {}", b, round);
            Random random(seed, stream);
            std::optional<Random> own;
            if (has_own_stream(number)) own.emplace(seed, stream_of(stream, number));
            ++block_number;
            for (Trial trial : trials_of(task, task.blocks[b], round, row, random, own)) {
                trial.block = static_cast<int>(b);
                trial.number = block_number;
                out.push_back(trial);
            }
        }
    };
    const auto rounds = static_cast<int>(task.rounds.size());
    add(rounds, Once::before);
    for (const int round : ordered(std::max(1, rounds), task.round_order, row, rounds_random))
        add(round, Once::no);
    add(rounds, Once::after);
    draw_for(out, task, number, seed);
    return out;
}

std::vector<Table::Column> own_columns(const Task& task) {
    std::vector<Table::Column> out;
    for (const Factor& factor : factors_of(task))
        out.push_back({factor.factor, "level of a factor"});
    for (const DrawSpec& draw : task.draws) out.push_back({draw.name, "drawn for the trial"});
    return out;
}

Table trial_list(const Task& task, const std::vector<Trial>& trials) {
    Table table;
    table.columns = kTrialListColumns;
    for (const Table::Column& column : own_columns(task)) table.columns.push_back(column);
    const std::vector<Factor> factors = factors_of(task);
    for (size_t i = 0; i < trials.size(); ++i) {
        const Trial& t = trials[i];
        const rows::AskedRow row{static_cast<int>(i) + 1,
                                 t.number,
                                 task.blocks[static_cast<size_t>(t.block)].name,
                                 t.in_block,
                                 t.kind,
                                 name_at(task.rounds, t.round),
                                 name_at(task.conditions, t.condition),
                                 perturbations_cell(task, t.perturb),
                                 t.share,
                                 name_at(task.procedures, t.procedure)};
        table.rows.push_back(list_figures(row).cells);
        add_own_cells(task, factors, t, table.rows.back());
    }
    return table;
}

/// Reads the numbers in a row of a frozen list.
template <class Bad>
void read_numbers(Trial& trial, const std::vector<std::string>& row, const Bad& bad) {
    const auto number = whole_number<int>(row[1]);
    const auto in_block = whole_number<int>(row[3]);
    const auto share = finite_number(row[8]);
    if (!number) throw bad("block_num");
    if (!in_block) throw bad("trial_num_in_block");
    if (!share && !row[8].empty()) throw bad("share");
    trial.number = *number;
    trial.in_block = *in_block;
    trial.share = share.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::vector<Trial> read_trial_list(const Task& task, const std::string& file) {
    const auto rows = read_csv(file);
    std::vector<Trial> out;
    if (rows.size() < 2) {
        throw Error({file, 0}, "", "has no trial",
                    "Restore the list with which the session was recorded.");
    }
    const Index blocks(task.blocks), rounds(task.rounds), conditions(task.conditions),
        procedures(task.procedures), perturbations(task.perturbations);
    for (size_t i = 1; i < rows.size(); ++i) {
        const auto& row = rows[i];
        const auto bad = [&](const char* column) {
            return Error({file, static_cast<int>(i) + 1}, column, "does not belong to this task",
                         "Restore the list with which the session was recorded.");
        };
        if (row.size() < 10) throw bad("trial_num");
        Trial t;
        read_numbers(t, row, bad);
        t.block = blocks(row[2]);
        const auto kind = enum_named<TrialKind>(row[4]);
        const bool beside = task.rounds.empty() || row[5].empty();
        t.round = beside ? static_cast<int>(task.rounds.size()) : rounds(row[5]);
        t.condition = task.conditions.empty() ? 0 : conditions(row[6]);
        t.perturb = read_perturbations(perturbations, row[7]);
        t.procedure = procedures(row[9]);
        if (t.block < 0) throw bad("block");
        if (!kind) throw bad("kind");
        if (t.round < 0) throw bad("round");
        if (t.condition < 0) throw bad("condition");
        if (std::find(t.perturb.begin(), t.perturb.end(), -1) != t.perturb.end())
            throw bad("perturbation");
        if (t.procedure < 0 && !row[9].empty()) throw bad("procedure");
        t.kind = *kind;
        t.draws = read_draws(task, rows[0], row, bad);
        out.push_back(t);
    }
    return out;
}

TrialQueue::TrialQueue(const std::vector<Trial>& trials, Redo redo, int most_attempts,
                       uint64_t seed)
    : trials_(&trials),
      redo_(redo),
      most_attempts_(most_attempts),
      random_(seed, "trials to be done again"),
      attempts_(trials.size(), 1) {
    queue_.reserve(trials.size() * static_cast<size_t>(most_attempts));
    queue_.resize(trials.size());
    std::iota(queue_.begin(), queue_.end(), 0);
}

bool TrialQueue::go_to(int trial, int attempt) noexcept {
    const auto next = queue_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto found = std::find(next, queue_.end(), trial);
    if (found == queue_.end()) return false;
    std::rotate(next, found, found + 1);
    int& made = attempts_[static_cast<size_t>(trial)];
    made = std::max(made, attempt);
    return true;
}

void TrialQueue::finish(bool redo) noexcept {
    const int now = trial();
    ++at_;
    int& attempt = attempts_[static_cast<size_t>(now)];
    if (!redo || redo_ == Redo::never || attempt >= most_attempts_) return;
    ++attempt;
    const int block = (*trials_)[static_cast<size_t>(now)].number;
    size_t end = at_;
    while (end < queue_.size() && (*trials_)[static_cast<size_t>(queue_[end])].number == block)
        ++end;
    size_t place = redo_ == Redo::next ? at_ : end;
    if (redo_ == Redo::random) {
        const double last = static_cast<double>(end - at_ + 1);
        place = at_ + std::min(end - at_, static_cast<size_t>(random_.uniform(0, last)));
    }
    queue_.insert(queue_.begin() + static_cast<std::ptrdiff_t>(place), now);
}

}  // namespace dihaptic::task
