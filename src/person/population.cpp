#include "person/population.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/field_writer.h"
#include "base/installed.h"
#include "base/named_file.h"
#include "base/number.h"
#include "base/random.h"
#include "person/shipped_populations.h"

namespace dihaptic::person {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostGroups = 1000;  // limits the time needed to check the traits of all groups
constexpr double kFarthest = 2.5;     // largest |z|, i.e. distance of a person from the median

/// Traits that are zero in people who show no noise and make no mistakes.
constexpr std::array kNoise{"visual_noise",  "reaction_noise", "tempo_noise",    "direction_noise",
                            "adapted_noise", "extent_noise",   "grip_noise",     "load_time_noise",
                            "reflex_noise",  "force_noise",    "friction_error", "hesitation_rate",
                            "slip_rate",     "give_up_rate"};

/// A trait of a person who differs from the laboratory's median by z, where the laboratory differs
/// from other laboratories by y.
double drawn(const TraitSpread& row, double z, double y) {
    const double median = *row.median;
    const double shift = *row.spread * z + row.between_laboratories.value_or(0) * y;
    switch (*row.law) {
        case Law::normal:
            return median + shift;
        case Law::log_normal:
            return median * std::exp(shift);
        case Law::logit:
            return 1 / (1 + (1 / median - 1) * std::exp(-shift));
        case Law::forgetting:
            return 1 - (1 - median) * std::exp(-shift);
    }
    return median;
}

/// The trait with the given name; null if there is none.
auto find(auto& traits, const std::string& name) {
    const auto found = std::find_if(traits.begin(), traits.end(),
                                    [&](const TraitSpread& t) { return t.trait == name; });
    return found == traits.end() ? nullptr : &*found;
}

/// Overwrites those members of `trait` that are set in `change`.
void overlay(TraitSpread& trait, const TraitSpread& change) {
    if (change.law) trait.law = change.law;
    if (change.median) trait.median = change.median;
    if (change.spread) trait.spread = change.spread;
    if (change.between_laboratories) trait.between_laboratories = change.between_laboratories;
    if (!change.source.empty()) trait.source = change.source;
    trait.place = change.place;
}

/// The traits of the population, with the changes made for one group.
std::vector<TraitSpread> traits_of(const Population& population, const std::string& group) {
    std::vector<TraitSpread> out = population.traits;
    for (const Group& one : population.groups) {
        if (one.name != group) continue;
        for (const TraitSpread& change : one.traits) {
            if (TraitSpread* trait = find(out, change.trait)) overlay(*trait, change);
        }
    }
    return out;
}

/// Traits with the given values, in the units that the names in `rows` state. Reports values that
/// are out of bounds to `diagnostics`.
Traits traits_with(const std::vector<TraitSpread>& rows, const std::vector<double>& values,
                   Diagnostics& diagnostics) {
    Node node = Node::mapping();
    for (size_t i = 0; i < rows.size(); ++i) {
        Node value = Node::number(values[i]);
        value.place = rows[i].place;
        node.set(rows[i].trait, std::move(value));
    }
    Traits out;
    read_fields(out, node, diagnostics);
    return out;
}

/// Collects the names of traits, without units.
struct TraitNames {
    std::vector<std::string> names;

    void operator()(std::string_view name, double&, Field) { names.emplace_back(name); }
    void operator()(std::string_view, std::string&) {}
    void operator()(std::string_view, Objects&) {}
    void operator()(std::string_view, int&, Field) {}
};

const std::vector<std::string>& all_traits() {
    static const std::vector<std::string> names = [] {
        TraitNames list;
        Traits traits;
        traits.visit(list);
        return list.names;
    }();
    return names;
}

/// Removes the unit from a trait's key: "direction_noise_deg" and "direction_noise_rad" are the
/// same trait, direction_noise.
std::string without_unit(const std::string& trait) {
    std::string out = trait;
    for (const std::string& name : all_traits()) {
        if (trait == name) return name;
        if (trait.rfind(name + "_", 0) == 0) out = name;
    }
    return out;
}

/// Checks that all traits are within bounds at the median and at both extremes.
void check_bounds(const Population& population, const std::string& group,
                  Diagnostics& diagnostics) {
    const auto rows = traits_of(population, group);
    for (const double z : {0.0, -kFarthest, kFarthest}) {
        std::vector<double> values;
        for (const TraitSpread& row : rows) values.push_back(drawn(row, z, z));
        Diagnostics found;
        traits_with(rows, values, found);
        diagnostics.add(found.problems());
        if (found.has_errors()) return;
    }
}

void check_group(const Population& population, const Group& group, Diagnostics& diagnostics) {
    for (const TraitSpread& change : group.traits) {
        if (find(population.traits, change.trait) == nullptr)
            diagnostics.error(change.place, change.trait, "is not a trait of this population",
                              "Write its name and unit as in the population's traits.");
    }
    check_bounds(population, group.name, diagnostics);
}

/// The correlation matrix of all traits, in the order of the traits, over people or over
/// laboratories (`r`).
Eigen::MatrixXd correlations(const Population& population, double Correlation::*r) {
    const auto n = static_cast<Eigen::Index>(population.traits.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Identity(n, n);
    const auto index = [&](const std::string& name) {
        Eigen::Index i = 0;
        while (population.traits[static_cast<size_t>(i)].trait != name) ++i;
        return i;
    };
    for (const Correlation& c : population.correlations) {
        const auto a = index(c.traits[0]);
        const auto b = index(c.traits[1]);
        out(a, b) = out(b, a) = c.*r;
    }
    return out;
}

void check_correlations(const Population& population, const std::string& file,
                        Diagnostics& diagnostics) {
    std::set<std::set<std::string>> pairs;
    for (const Correlation& c : population.correlations) {
        for (const std::string& name : c.traits) {
            if (find(population.traits, name) == nullptr)
                diagnostics.error(c.place, name, "is not a trait of this population",
                                  "Write its name and unit as in the population's traits.");
        }
        const std::set<std::string> pair(c.traits.begin(), c.traits.end());
        if (c.traits.size() != 2 || pair.size() != 2) {
            diagnostics.error(c.place, "traits", "are not two traits",
                              "Write e.g. traits: [a, b].");
        } else if (!pairs.insert(pair).second) {
            diagnostics.error(c.place, "traits", "already have a correlation", "Keep one of them.");
        }
    }
    if (diagnostics.has_errors() || population.correlations.empty()) return;
    for (const auto r : {&Correlation::r, &Correlation::between_laboratories}) {
        if (Eigen::LLT<Eigen::MatrixXd>(correlations(population, r)).info() == Eigen::Success)
            continue;
        diagnostics.error({file, 0}, "correlations", "contradict each other",
                          "Three or more traits cannot be correlated arbitrarily: make the "
                          "correlations smaller.");
        return;
    }
}

void check(const Population& population, const std::string& file, Diagnostics& diagnostics) {
    for (const TraitSpread& trait : population.traits) {
        if (!trait.law || !trait.median || !trait.spread)
            diagnostics.error(trait.place, trait.trait, "has no law, median or spread",
                              "Write e.g. law: log_normal, median: 0.1, spread: 0.2.");
    }
    for (const std::string& name : all_traits()) {
        const auto& traits = population.traits;
        if (std::none_of(traits.begin(), traits.end(),
                         [&](const TraitSpread& t) { return without_unit(t.trait) == name; }))
            diagnostics.error(
                {file, 0}, name, "is missing",
                "Give every trait, or base the file on another one: based_on: adults.yaml.");
    }
    if (diagnostics.has_errors()) return;
    check_bounds(population, "", diagnostics);
    if (population.groups.size() > kMostGroups) {
        diagnostics.error({file, 0}, "groups",
                          fmt::format("there are {}, but at most {} are allowed",
                                      population.groups.size(), kMostGroups),
                          "Leave some out, or distribute them over several files.");
        return;
    }
    for (const Group& group : population.groups) check_group(population, group, diagnostics);
    check_correlations(population, file, diagnostics);
}

/// The population `change`, completed with the parts that only `base` has.
Population resolved(Population change, Population base) {
    for (const TraitSpread& trait : change.traits) {
        if (TraitSpread* there = find(base.traits, trait.trait)) {
            overlay(*there, trait);
        } else {
            base.traits.push_back(trait);  // check() reports faults in the trait
        }
    }
    change.traits = std::move(base.traits);
    if (change.correlations.empty()) change.correlations = std::move(base.correlations);
    if (change.groups.empty()) change.groups = std::move(base.groups);
    if (change.laboratories == 0) change.laboratories = base.laboratories;
    change.based_on.clear();
    return change;
}

Population parse(const Node& node, Diagnostics& diagnostics) {
    Population out;
    read_fields(out, node, diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

Population checked(Population population, const std::string& file, Diagnostics& diagnostics) {
    check(population, file, diagnostics);
    diagnostics.throw_if_errors();
    return population;
}

Population read_shipped(Objects objects) {
    Diagnostics diagnostics;
    const auto text = [&](std::string_view yaml, const char* name) {
        return parse(parse_yaml(std::string(yaml), name), diagnostics);
    };
    Population out = text(kAdults, "populations/adults.yaml");
    if (objects == Objects::real) {
        out = resolved(text(kAdultsRealObjects, "populations/adults-real-objects.yaml"),
                       std::move(out));
    }
    return checked(std::move(out), "populations", diagnostics);
}

/// The number at the end of an identifier; 1 if there is no number or if it has more than nine
/// digits.
size_t number_of(const std::string& id) {
    const size_t last = id.find_last_not_of("0123456789");
    const std::string digits = id.substr(last == std::string::npos ? 0 : last + 1);
    return digits.empty() || digits.size() > 9 ? 1 : *whole_number<size_t>(digits);
}

Traits with_names(Traits traits, const Population& population, const std::string& group,
                  const std::string& id) {
    traits.id = id;
    traits.population = population.title;
    traits.group = group;
    traits.objects = population.objects;
    return traits;
}

/// Reads a file and the files on which it is based. `above`: the files that are based on this one.
Population read_based(std::set<fs::path> above, const std::string& file) {
    Diagnostics diagnostics;
    const Node root = read_yaml(file);
    Population out = parse(root, diagnostics);
    if (!out.based_on.empty()) {
        const Place place = root.find("based_on")->place;
        above.insert(fs::weakly_canonical(file));
        const fs::path base = named_in(fs::path(file).parent_path().string(), out.based_on);
        if (above.contains(fs::weakly_canonical(base)))
            throw Error(
                place, "based_on", "leads back to the file itself",
                "Name a file that is not based on any other, or that is based on a different one.");
        check_named(base.string(), place, "based_on");
        out = resolved(std::move(out), read_based(above, base.string()));
    }
    return checked(std::move(out), file, diagnostics);
}

}  // namespace

std::string Population::group_of(const std::string& id) const {
    if (groups.empty()) return "";
    return groups[(number_of(id) + groups.size() - 1) % groups.size()].name;
}

int Population::number_in_group(const std::string& id) const {
    const size_t each = std::max<size_t>(1, groups.size());
    return static_cast<int>((number_of(id) + each - 1) / each);
}

Population read_population(const std::string& file) {
    return read_based({}, file);
}

const Population& shipped_population(Objects objects) {
    static const Population device = read_shipped(Objects::device);
    static const Population real = read_shipped(Objects::real);
    return objects == Objects::real ? real : device;
}

Population population_of(const std::string& file, Objects objects) {
    return file.empty() ? shipped_population(objects) : read_population(file);
}

int Population::laboratory_of(const std::string& id) const {
    return laboratories == 0 ? 0 : (number_in_group(id) - 1) % laboratories + 1;
}

Traits median_person(const Population& population, const std::string& group) {
    const auto rows = traits_of(population, group);
    std::vector<double> values;
    for (const TraitSpread& row : rows) {
        const bool noise =
            std::find(kNoise.begin(), kNoise.end(), without_unit(row.trait)) != kNoise.end();
        values.push_back(noise ? 0 : *row.median);
    }
    Diagnostics diagnostics;
    const Traits out = traits_with(rows, values, diagnostics);
    diagnostics.throw_if_errors();
    return with_names(out, population, group, "");
}

Traits draw_person(const Population& population, uint64_t seed, const std::string& id) {
    return draw_person(population, seed, id, population.group_of(id), population.laboratory_of(id));
}

Traits draw_person(const Population& population, uint64_t seed, const std::string& id,
                   const std::string& group, int laboratory) {
    const auto rows = traits_of(population, group);
    const auto deviations = [&](const std::string& whose, double Correlation::*r) {
        Eigen::VectorXd u(static_cast<Eigen::Index>(rows.size()));
        for (Eigen::Index i = 0; i < u.size(); ++i) {
            const std::string trait = without_unit(rows[static_cast<size_t>(i)].trait);
            u[i] = Random(seed, fmt::format("{}, {}", whose, trait)).normal();
        }
        const Eigen::VectorXd z =
            Eigen::LLT<Eigen::MatrixXd>(correlations(population, r)).matrixL() * u;
        return Eigen::VectorXd(z.cwiseMax(-kFarthest).cwiseMin(kFarthest));
    };
    const auto z = deviations("person " + id, &Correlation::r);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(z.size());
    if (laboratory > 0)
        y = deviations(fmt::format("laboratory {}", laboratory),
                       &Correlation::between_laboratories);
    std::vector<double> values;
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        values.push_back(drawn(rows[i], z[k], y[k]));
    }
    Diagnostics diagnostics;
    Traits out = traits_with(rows, values, diagnostics);
    diagnostics.throw_if_errors();
    out.laboratory = laboratory;
    return with_names(out, population, group, id);
}

Traits median_person(Objects objects) {
    return median_person(shipped_population(objects));
}

Traits draw_person(Objects objects, uint64_t seed, const std::string& id) {
    return draw_person(shipped_population(objects), seed, id);
}

}  // namespace dihaptic::person
