// Populations that simulated people are drawn from, as files have them: of each trait its median,
// its spread and where both are from, correlations between traits, and groups that differ.
//
// A person's trait is drawn by its law from a normal number z, which is cut at 2.5. The numbers of
// correlated traits are z = L u with u independent and R = L L^T the matrix of correlations. Each u
// comes from a stream of its own, named for the person and the trait: who is drawn is the same
// whoever else is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "person/traits.h"

namespace dihaptic::person {

/// How a trait is spread over people, about its median.
enum class Law {
    normal,      ///< median + spread z
    log_normal,  ///< median exp(spread z)
    logit,       ///< logit(p) = logit(median) + spread z: stays within 0 and 1
    forgetting,  ///< 1 - p is log-normal: a retention near 1
};
constexpr auto enum_names(Law) {
    return std::array{"normal", "log_normal", "logit", "forgetting"};
}

/// One trait; in a group, or over another file's, what it leaves out stays as it is there.
struct TraitSpread {
    std::string trait;  ///< as person.yaml has it, with a unit where it has one
    std::optional<Law> law;
    std::optional<double> median;  ///< in that unit
    std::optional<double> spread;  ///< multiplies z in the law
    std::string source;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("trait", trait, Field::text().required());
        v("law", law);
        v("median", median);
        v("spread", spread, Field::number().within(0, 10));
        v("source", source);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Correlation {
    std::vector<std::string> traits;  ///< two
    double r = 0;                     ///< of their z
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("traits", traits, Field::text().required());
        v("r", r, Field::number().within(-0.99, 0.99));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Group {
    std::string name;
    std::vector<TraitSpread> traits;  ///< that differ
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("traits", traits);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

struct Population {
    std::string title;
    std::string about;     ///< in words
    std::string based_on;  ///< another file, beside this one, that this one changes; empty: none
    Objects objects = Objects::device;
    std::vector<TraitSpread> traits;
    std::vector<Correlation> correlations;
    std::vector<Group> groups;  ///< people are of each in turn; none: all are alike

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, Field::text().required());
        v("about", about);
        v("based_on", based_on);
        v("objects", objects);
        v("traits", traits);
        v("correlations", correlations);
        v("groups", groups);
    }

    /// The group of a person, by the number that ends `id`; empty without groups.
    std::string group_of(const std::string& id) const;
    /// Number of a person among those of its group, from 1: by the identifier's own, orders that
    /// are counterbalanced over people would differ from group to group.
    int number_in_group(const std::string& id) const;
};

/// Reads a population file, with the one that it is based on. Throws Error with everything that is
/// wrong: a trait that is none, or is missing, or that 2.5 SDs lead out of its bounds; correlations
/// that cannot be.
Population read_population(const std::string& file);
/// populations/adults.yaml, or adults-real-objects.yaml, as the program was built with them.
const Population& shipped_population(Objects objects);

/// The median person of a group, who makes neither noise nor mistakes.
Traits median_person(const Population& population, const std::string& group = "");
/// Person `id` of the population with this seed: the same whenever, and whoever else is drawn.
Traits draw_person(const Population& population, uint64_t seed, const std::string& id);

/// The same of the shipped populations.
Traits median_person(Objects objects);
Traits draw_person(Objects objects, uint64_t seed, const std::string& id);

}  // namespace dihaptic::person
