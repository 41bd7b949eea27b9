#include "rehearse_command.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/number.h"
#include "base/shell_word.h"
#include "person/population.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

std::string whole(const std::string& file) {
    std::string out = fs::absolute(file).lexically_normal().string();
    while (out.size() > 1 && out.ends_with('/')) out.pop_back();
    return out;
}

std::string word(const std::string& file) {
    return shell_word(whole(file));
}

/// The words that start the program: this program, or the program in a container.
std::string program(std::string container) {
    // set inside a container; a folder if Apptainer has unpacked the file just for this command
    const char* const here = std::getenv("APPTAINER_CONTAINER");
    std::error_code unreadable;
    if (container.empty() && here != nullptr && fs::is_regular_file(here, unreadable))
        container = here;
    if (container.empty()) return word(fs::read_symlink("/proc/self/exe"));
    return "apptainer exec " + word(container) + " dihaptic";
}

/// Parses a number from 1 to `most`; nullopt if the word is not such a number.
std::optional<int> number(const std::string& word, int most) {
    const auto out = whole_number<int>(word);
    return out && *out >= 1 && *out <= most ? out : std::nullopt;
}

/// Reads the option at `words[at]` and its value into `command`. Returns the index of the word that
/// follows; nullopt if the option is unknown or its value is invalid.
std::optional<size_t> take(const std::vector<std::string>& words, size_t at,
                           RehearseCommand& command) {
    const std::string& option = words[at];
    if (option == "--real-objects" || option == "--keep-recordings") {
        (option == "--real-objects" ? command.real_objects : command.keep_recordings) = true;
        return at + 1;
    }
    if (at + 1 == words.size()) return std::nullopt;
    const std::string& value = words[at + 1];
    if (option == "--population") {
        if (!value.starts_with('/')) return std::nullopt;
        command.population = value;
    } else if (option == "--laboratories") {
        const auto laboratories = number(value, person::kMostLaboratories);
        if (!laboratories) return std::nullopt;
        command.laboratories = *laboratories;
    } else if (option == "--jobs") {
        const auto jobs = number(value, 1024);
        if (!jobs) return std::nullopt;
        command.jobs = *jobs;
    } else if (option != "--people" && option != "--seed" && option != "--out") {
        return std::nullopt;  // command_of() sets these three from other sources
    }
    return at + 2;
}

std::optional<RehearseCommand> parse(const std::string& text) {
    auto words = shell_words(text);
    if (words && words->size() > 4 && (*words)[0] == "apptainer" && (*words)[1] == "exec")
        // the container is left out, because its program may come from a stranger
        words->erase(words->begin(), words->begin() + 3);
    if (!words || words->size() < 3 || (*words)[1] != "rehearse" || !(*words)[2].starts_with('/'))
        return std::nullopt;
    RehearseCommand out;
    out.file = (*words)[2];
    for (size_t at = 3; at < words->size();) {
        const auto next = take(*words, at, out);
        if (!next) return std::nullopt;
        at = *next;
    }
    return out;
}

}  // namespace

std::string RehearseCommand::text() const {
    std::string text = fmt::format("{} rehearse {} --people {} --seed {} --out {}",
                                   program(container), word(file), people, seed, word(out));
    if (!population.empty()) text += " --population " + word(population);
    if (laboratories > 0) text += fmt::format(" --laboratories {}", laboratories);
    if (real_objects) text += " --real-objects";
    if (keep_recordings) text += " --keep-recordings";
    if (jobs != 1) text += fmt::format(" --jobs {}", jobs);
    return text;
}

std::optional<std::string> command_of(const std::string& folder,
                                      const session::Rehearsal& rehearsal) {
    if (rehearsal.asked.command == kByPython) return kByPython;
    auto command = parse(rehearsal.asked.command);
    if (!command) return std::nullopt;
    command->people = rehearsal.asked.people;
    command->seed = shell_word(rehearsal.seed);
    command->out = folder;
    return command->text();
}

}  // namespace dihaptic::cli
