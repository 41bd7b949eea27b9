// Tests that visit() describes every key of a file, and that docs/reference.md agrees with visit().
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <typeindex>

#include "base/field_writer.h"
#include "base/number.h"
#include "frame/settings.h"
#include "person/population.h"
#include "rig/kinds.h"
#include "scene/kinds.h"
#include "study/study_file.h"
#include "task/file/experiment.h"
#include "task/file/kinds.h"
#include "testing/files.h"

namespace dihaptic::task::reference_test {
namespace {

constexpr const char* kFile = "docs/reference.md";

struct Key {
    std::string name;
    std::string type;
    std::string bounds;
    std::string what;
    std::string preset;                ///< the default
    std::vector<std::string> kinds{};  ///< kinds of the struct for which the key exists

    bool same(const Key& other) const {
        return name == other.name && type == other.type && bounds == other.bounds &&
               what == other.what;
    }
};

std::string number(double value) {
    return fmt::format("{:.6g}", value);
}

std::string bounds_of(const Field& field) {
    const bool low = std::isfinite(field.min);
    const bool high = std::isfinite(field.max);
    if (!low && !high) return "";
    if (!low) return "at most " + number(field.max);
    const std::string from = (field.above_min ? "above " : "") + number(field.min);
    if (!high) return field.above_min ? from : "at least " + from;
    return from + (field.above_min ? ", at most " : " to ") + number(field.max);
}

std::string link_to(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
            anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (c == ' ') anchor += '-';
    }
    return fmt::format("[{}](#{})", heading.substr(heading.rfind('.') + 1), anchor);
}

/// Returns copies of a struct, one of each kind, together with the kind in words.
template <class Struct>
std::vector<std::pair<std::string, Struct>> each_kind_of(const Struct& value) {
    std::vector<std::pair<std::string, Struct>> out;
    if constexpr (HasKinds<Struct>) {
        for (const auto& [word, one] : kinds_of(value).each)
            out.emplace_back(word.empty() ? "an expression" : fmt::format("`{}`", word), one);
    } else {
        out.emplace_back("", value);
    }
    return out;
}

/// The reference page, which has a section for each struct. The sections of structs that contain
/// another struct link to its section.
class Page {
  public:
    std::string text;

    /// Sets the heading of the struct's section, which otherwise is the first key that refers to
    /// the struct.
    template <class Struct>
    void name(const std::string& heading) {
        headings_[typeid(Struct)] = heading;
    }
    /// Adds a section at the top level.
    template <class Struct>
    void part(const std::string& heading, const std::string& about) {
        text += fmt::format("## {}\n\n{}\n\n", heading, about);
        write(Struct{}, heading);
    }
    /// Notes that a struct has a part of its own.
    template <class Struct>
    void has_part(const std::string& heading) {
        name<Struct>(heading);
        written_.insert(typeid(Struct));
    }

    /// Returns a link to the struct's section. If this section does not exist yet, it will be
    /// written after the current section.
    template <class Struct>
    std::string section(const Struct& value, const std::string& by_key) {
        const std::string heading = headings_.try_emplace(typeid(Struct), by_key).first->second;
        if (written_.insert(typeid(Struct)).second) {
            waiting_.push_back([this, value, heading] {
                text += fmt::format("### {}\n\n", heading);
                write(value, heading);
            });
        }
        return link_to(heading);
    }

  private:
    template <class Struct>
    void write(const Struct& value, const std::string& heading);

    std::map<std::type_index, std::string> headings_;
    std::set<std::type_index> written_;
    std::vector<std::function<void()>> waiting_;
};

/// A visitor that lists the keys of a struct.
class Lister {
  public:
    Lister(Page& page, std::string path) : page_(page), path_(std::move(path)) {}

    std::vector<Key> keys;

    void operator()(std::string_view name, const double& value, Field field = {}) {
        add(name, kind(field), field, value);
    }
    void operator()(std::string_view name, const std::optional<double>& value, Field field = {}) {
        add(name, kind(field), field, value);
    }
    void operator()(std::string_view name, const Vec3& value, Field field = {}) {
        add(name, "3 x " + kind(field), field, value);
    }
    void operator()(std::string_view name, const std::optional<Vec3>& value, Field field = {}) {
        add(name, "3 x " + kind(field), field, value);
    }
    void operator()(std::string_view name, const Formula& value, Field field = {}) {
        add(name, kind(field) + " or formula", field, value);
    }
    void operator()(std::string_view name, const std::optional<Formula>& value, Field field = {}) {
        add(name, kind(field) + " or formula", field, value);
    }
    void operator()(std::string_view name, const FormulaVec3& value, Field field = {}) {
        add(name, "3 x " + kind(field) + " or formula", field, value);
    }
    void operator()(std::string_view name, const std::optional<FormulaVec3>& value,
                    Field field = {}) {
        add(name, "3 x " + kind(field) + " or formula", field, value);
    }
    void operator()(std::string_view name, const Mat3& value, Field field = {}) {
        add(name, "3 rows of 3 x " + kind(field), field, value);
    }
    void operator()(std::string_view name, const int& value, Field field = {}) {
        add(name, "whole number", field, value);
    }
    void operator()(std::string_view name, const bool& value, Field field = {}) {
        add(name, "yes or no", field, value);
    }
    void operator()(std::string_view name, const std::string& value, Field field = {}) {
        add(name, "text", field, value);
    }
    void operator()(std::string_view name, const std::vector<std::string>& value,
                    Field field = {}) {
        add(name, "list of texts", field, value);
    }
    void operator()(std::string_view name, const Texts& value, Field field = {}) {
        add(name, "text, or list of texts", field, value);
    }
    void operator()(std::string_view name, const std::vector<double>& value, Field field = {}) {
        add(name, "list of numbers", field, value);
    }
    void operator()(std::string_view name, const Node& value, Field field = {}) {
        const bool is_part = name == "settings" || name == "hand";
        add(name, is_part ? link_to(name == "hand" ? "Hand" : "Settings") : "keys", field, value);
    }
    template <NamedEnum E>
    void operator()(std::string_view name, const E& value, Field field = {}) {
        add(name, words<E>(), field, value);
    }
    template <NamedEnum E>
    void operator()(std::string_view name, const std::optional<E>& value, Field field = {}) {
        add(name, words<E>(), field, value);
    }
    template <class Struct>
    requires Described<Struct, Lister>
    void operator()(std::string_view name, Struct& value, Field field = {}) {
        add(name, page_.section(value, inner(name)), field, Node{});
    }
    template <class Struct>
    requires Described<Struct, Lister>
    void operator()(std::string_view name, std::optional<Struct>& value, Field field = {}) {
        add(name, page_.section(value.value_or(Struct{}), inner(name)), field, Node{});
    }
    template <class Struct>
    requires Described<Struct, Lister>
    void operator()(std::string_view name, std::vector<Struct>&, Field field = {}) {
        add(name, "list of " + page_.section(Struct{}, inner(name)), field, Node{});
    }
    /// A value that can be either just a list or a mapping is described as a mapping.
    static bool is_list(std::string_view) { return false; }

  private:
    static std::string kind(const Field& field) { return std::string(name(field.quantity)); }
    static std::string_view name(Quantity quantity) { return dihaptic::name(quantity); }
    template <class E>
    static std::string words() {
        std::string out;
        for (const std::string word : enum_names(E{}))
            if (!word.empty()) out += (out.empty() ? "`" : ", `") + word + "`";
        return out;
    }
    std::string inner(std::string_view name) const { return path_ + "." + std::string(name); }

    template <class T>
    void add(std::string_view name, std::string type, const Field& field, const T& value) {
        FieldWriter writer;
        writer(name, value, field);
        const Node written = writer.take();
        const bool given = !written.entries.empty() && !field.is_required;
        keys.push_back(
            {si_key(name, field.quantity), std::move(type), bounds_of(field),
             std::string(field.what),
             field.is_required ? "required" : shown(given ? written.entries[0].value : Node{})});
    }
    static std::string shown(const Node& node) {
        if (node.kind == Node::Kind::sequence) {
            std::vector<std::string> items;
            for (const Node& item : node.items) items.push_back(shown(item));
            return items.empty() ? "" : fmt::format("[{}]", fmt::join(items, ", "));
        }
        if (node.kind != Node::Kind::scalar || node.scalar.empty()) return "";
        const auto value = any_number(node.scalar);
        return value ? number(*value) : node.scalar;
    }

    Page& page_;
    std::string path_;
};

bool is_sentence(const std::string& text) {
    return text.size() > 1 && text.back() == '.' &&
           std::islower(static_cast<unsigned char>(text.front())) == 0 &&
           text.find_first_of("|\n") == std::string::npos;
}

template <class Struct>
void Page::write(const Struct& value, const std::string& heading) {
    std::vector<Key> all;
    size_t kinds = 0;
    waiting_.clear();
    for (auto& [kind, one] : each_kind_of(value)) {
        ++kinds;
        Lister lister(*this, heading);
        one.visit(lister);
        size_t at = 0;
        for (Key& key : lister.keys) {
            const auto known =
                std::find_if(all.begin(), all.end(), [&](const Key& k) { return k.same(key); });
            if (known != all.end()) {
                known->kinds.push_back(kind);
                at = static_cast<size_t>(known - all.begin()) + 1;
            } else {
                key.kinds.push_back(kind);
                all.insert(all.begin() + static_cast<long>(at++), key);
            }
        }
    }
    text += "| key | type | default | bounds | meaning |\n|---|---|---|---|---|\n";
    for (const Key& key : all) {
        EXPECT_TRUE(is_sentence(key.what)) << heading << "." << key.name << ": " << key.what;
        const std::string only =
            key.kinds.size() == kinds ? "" : fmt::format("{}: ", fmt::join(key.kinds, ", "));
        text += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.name, key.type, key.preset,
                            key.bounds, only, key.what);
    }
    text += "\n";
    for (const auto& inner : std::exchange(waiting_, {})) inner();
}

std::string tables() {
    Page page;
    page.has_part<hand::HandSpec>("Hand");
    page.name<LoadSpec>("Experiment.task.perturbations.loads");
    page.part<Experiment>("Experiment", "An experiment file.");
    page.part<scene::Scene>("Scene", "A scene file.");
    page.part<rig::Rig>("Rig", "A rig file.");
    page.part<frame::Settings>("Settings",
                               "What `settings` of scene, rig and experiment have, and `--set`.");
    page.part<hand::HandSpec>("Hand", "What `hand` of scene and experiment have.");
    page.part<person::Population>("Population", "A file of people for rehearsals.");
    page.part<study::StudyFile>("Study", "A file of groups and sessions.");
    page.text.pop_back();
    return page.text;
}

/// Only the tables are generated, not the text before them.
TEST(Reference, HasEachKeyOfFiles) {
    const std::string page = testing::read_file(kFile);
    const std::string made = page.substr(0, page.find("## Experiment")) + tables();
    if (std::getenv("DIHAPTIC_RENEW_REFERENCE") != nullptr) {
        std::ofstream(kFile) << made;
    } else {
        EXPECT_EQ(page, made) << kFile
                              << " says something else than visit(). Renew it in the same commit: "
                              << "DIHAPTIC_RENEW_REFERENCE=1 build/release/src/task/task_test "
                              << "--gtest_filter='Reference.*'";
    }
}

}  // namespace
}  // namespace dihaptic::task::reference_test
