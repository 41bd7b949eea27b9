#include "drawable.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "frame/frame.h"
#include "task/run/recorded.h"

namespace dihaptic::gui {
namespace {

/// The sentences about the quantities of a frame.
class Sentences {
  public:
    Sentences() {
        const frame::Frame frame;
        frame::Frame::visit(frame, *this);
    }

    // called by Frame::visit() for each field
    template <class T>
    void operator()(const T&, const frame::Term& term) {
        all_[list_].emplace(term.name, term.meaning);
    }
    template <class T>
    void each(const char* name, const std::vector<T>&, const char*) {
        const std::string before = std::exchange(list_, name);
        const T item{};
        T::visit(item, *this);
        list_ = before;
    }
    template <class T>
    void changed(const char* name, const std::vector<T>& list, const std::vector<uint16_t>&,
                 const char* meaning) {
        each(name, list, meaning);
    }

    /// The sentence about a quantity in a list of a frame; in "", of the frame as a whole. Empty if
    /// there is none.
    std::string of(const std::string& list, const std::string& quantity) const {
        const auto quantities = all_.find(list);
        if (quantities == all_.end()) return "";
        const auto found = quantities->second.find(quantity);
        return found == quantities->second.end() ? "" : found->second;
    }

  private:
    std::string list_;
    std::map<std::string, std::map<std::string, std::string>> all_;
};

/// The quantity that a short form such as block.z stands for.
std::string written_out(const std::string& list, const std::string& quantity) {
    const bool is_component = quantity == "x" || quantity == "y" || quantity == "z";
    if (!is_component) return quantity;
    return list == "bodies" ? "position" : "handle_position";
}

/// Describes quantities of a scene's frames by their names in expressions.
class Describer {
  public:
    explicit Describer(const scene::Scene& scene) {
        for (const std::string& name : scene::finger_names(scene)) lists_[name] = "fingers";
        for (const scene::Body& body : scene.bodies) lists_[body.name] = "bodies";
        for (const scene::Joint& joint : recorded_joints(scene)) lists_[joint.name] = "joints";
    }

    std::string describe(const std::string& name) const {
        const size_t dot = name.find('.');
        if (dot == std::string::npos) return sentences_.of("", name);
        std::string thing = name.substr(0, dot);
        std::erase(thing, '"');
        const std::string member = name.substr(dot + 1, name.find('.', dot + 1) - dot - 1);
        const auto list = lists_.find(thing);
        if (list == lists_.end()) return sentences_.of("", thing);  // a vector of the frame
        if (member == "speed") return "Speed.";
        if (member == "shown") return "Displayed position.";
        const std::string quantity = written_out(list->second, member);
        const std::string out = sentences_.of(list->second, quantity);
        return out.empty() && list->second == "fingers" ? sentences_.of("turns", quantity) : out;
    }

  private:
    Sentences sentences_;
    std::map<std::string, std::string> lists_;  // list of a frame to which each thing belongs
};

/// The names that the reader of expressions lists for an unknown name.
std::vector<std::string> names_in(const scene::Scene& scene) {
    Diagnostics diagnostics;
    const task::RecordedValue none("zz_no_word", scene, diagnostics);
    std::vector<std::string> out;
    for (const Problem& problem : diagnostics.problems()) {
        for (const Choice& choice : problem.choices) out.push_back(choice.word);
    }
    return out;
}

}  // namespace

std::vector<Choice> drawable_quantities(const scene::Scene& scene) {
    const Describer describer(scene);
    std::vector<Choice> out;
    std::set<std::string> listed;
    const auto add = [&](const std::string& name) {
        Diagnostics diagnostics;
        const task::RecordedValue value(name, scene, diagnostics);
        const std::string meaning = describer.describe(name);
        if (diagnostics.has_errors() || meaning.empty() || !listed.insert(name).second) return;
        const bool has_unit = !value.unit().empty() && value.unit() != "1";
        out.push_back({name, has_unit ? fmt::format("{} [{}]", meaning, value.unit()) : meaning});
    };
    for (const std::string& name : names_in(scene)) {
        for (const std::string component : {"", ".x", ".y", ".z"}) add(name + component);
    }
    // Clang 14 cannot compile std::ranges::stable_partition of GCC 12's library
    std::stable_partition(out.begin(), out.end(), [](const Choice& choice) {
        return choice.word.find('.') == std::string::npos;
    });
    return out;
}

}  // namespace dihaptic::gui
