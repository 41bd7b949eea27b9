// Populations from which simulated people are drawn, and population files: the median and spread of
// each trait with their source, correlations between traits, and groups that differ.
//
// The value of a trait follows from its law and a normally distributed number z, which is limited
// to between -2.5 and 2.5. Correlated traits have z = L u, where the elements of u are independent
// and R = L L^T is the correlation matrix. Each element of u comes from a random stream of its own,
// named after the person and the trait, so a person does not depend on which others are drawn.
//
// Laboratories differ in their instructions, apparatus and participants: the medians of their
// people are displaced, in the same laws, by `between_laboratories` y, where y is drawn for the
// laboratory as z is drawn for a person.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "person/traits.h"

namespace dihaptic::person {

/// How a trait is distributed over people, relative to its median.
enum class Law {
    normal,      ///< median + spread z
    log_normal,  ///< median exp(spread z)
    logit,       ///< logit(p) = logit(median) + spread z, which keeps p between 0 and 1
    forgetting,  ///< 1 - p is log-normal, for a retention p near 1
};
constexpr auto enum_names(Law) {
    return std::array{"normal", "log_normal", "logit", "forgetting"};
}

/// The spread of one trait. In a group, members that are omitted are taken from the population; in
/// a population, they are taken from the file on which it is based.
struct TraitSpread {
    std::string trait;  ///< key in person.yaml, including the unit, if there is one
    std::optional<Law> law;
    std::optional<double> median;                ///< in the unit of the key
    std::optional<double> spread;                ///< factor on z in the law
    std::optional<double> between_laboratories;  ///< factor on y; 0 if omitted
    std::string source;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("trait", trait,
          Field::text().required().says(
              "Name of the trait as in person.yaml, with its unit, if any."));
        v("law", law, says("Distribution of the trait over people."));
        v("median", median, says("Median of the trait, in the unit that its name gives."));
        v("spread", spread, Field::number().within(0, 10).says("Factor of z in the law."));
        v("between_laboratories", between_laboratories,
          Field::number().within(0, 10).says(
              "Spread of the median over laboratories, in the same law."));
        v("source", source, says("Source of these numbers."));
    }
};

struct Correlation {
    std::vector<std::string> traits;  ///< two
    double r = 0;                     ///< correlation between the z of the two traits
    double between_laboratories = 0;  ///< correlation between their y
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("traits", traits, Field::text().required().says("Two traits."));
        v("r", r, Field::number().within(-0.99, 0.99).says("Correlation of their z."));
        v("between_laboratories", between_laboratories,
          Field::number()
              .within(-0.99, 0.99)
              .says("Correlation of the medians of laboratories, in the traits' laws."));
    }
};

struct Group {
    std::string name;
    std::vector<TraitSpread> traits;  ///< traits that differ from those of the population
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the group."));
        v("traits", traits, says("Traits that differ from the population's."));
    }
};

struct Population {
    std::string title;
    std::string about;     ///< description, for human readers
    std::string based_on;  ///< path of the file that this one changes, relative to its own folder
    Objects objects = Objects::device;
    std::vector<TraitSpread> traits;
    std::vector<Correlation> correlations;
    std::vector<Group> groups;  ///< groups, to which people are assigned in turn; may be empty
    /// Number of laboratories from which people come in turn; 0 if all are from a median one.
    int laboratories = 0;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, Field::text().required().says("Title of the population."));
        v("about", about, says("Description for a reader."));
        v("based_on", based_on,
          says("Population file that this one changes, relative to this file."));
        v("objects", objects,
          says("Whether people feel objects directly or through a haptic device."));
        v("traits", traits, says("Distribution of each trait."));
        v("correlations", correlations, says("Correlations between traits."));
        v("groups", groups, says("Groups to which people are assigned in turn."));
        v("laboratories", laboratories,
          Field::number()
              .within(0, kMostLaboratories)
              .says("Number of laboratories from which people come in turn; 0 for one median "
                    "laboratory."));
    }

    /// Name of a person's group, which depends on the number at the end of `id`; empty if there are
    /// no groups.
    std::string group_of(const std::string& id) const;
    /// Number of a person within the group, from 1. It determines counterbalanced orders, because
    /// the number in `id` would give different groups different orders.
    int number_in_group(const std::string& id) const;
    /// Number of a person's laboratory, from 1; 0 if there are none.
    int laboratory_of(const std::string& id) const;
};

/// Reads a population file and the file on which it is based. Throws Error with all faults: unknown
/// or missing traits, traits that exceed their bounds at z = 2.5 or -2.5, and contradictory
/// correlations.
Population read_population(const std::string& file);
/// The population in populations/adults.yaml or in adults-real-objects.yaml, as embedded in the
/// program.
const Population& shipped_population(Objects objects);

/// The population in a file; the shipped population if `file` is "".
Population population_of(const std::string& file, Objects objects);

/// The median person of a group, who shows no noise and makes no mistakes.
Traits median_person(const Population& population, const std::string& group = "");
/// Draws person `id` from the population with this seed. The result does not depend on which other
/// people are drawn.
Traits draw_person(const Population& population, uint64_t seed, const std::string& id);
/// Draws person `id` from one group and one laboratory of the population; `laboratory` as returned
/// by Population::laboratory_of().
Traits draw_person(const Population& population, uint64_t seed, const std::string& id,
                   const std::string& group, int laboratory);

/// The median person of a shipped population.
Traits median_person(Objects objects);
Traits draw_person(Objects objects, uint64_t seed, const std::string& id);

}  // namespace dihaptic::person
