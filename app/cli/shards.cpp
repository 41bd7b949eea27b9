#include "shards.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "base/output.h"
#include "base/regular_file.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "common/console.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;
using session::Asked;

/// Part of a file name in quotes, for a line that starts with #SBATCH. sbatch expands sequences
/// that start with %, and cannot express the characters that are refused here.
std::string sbatch_name(const std::string& name) {
    std::string out;
    for (const char letter : name) {
        if (letter == '"' || letter == '\\' || static_cast<unsigned char>(letter) < ' ') {
            throw Error({name, 0}, "",
                        "contains a character that Slurm does not accept in a folder's name",
                        "Choose a folder without \", \\ and control characters: --out FOLDER.");
        }
        out += letter == '%' ? std::string("%%") : std::string(1, letter);
    }
    return out;
}

/// The line of the Slurm script that runs a shard.
std::string task_line(const Asked& asked) {
    return fmt::format("exec {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"\n", asked.command,
                       asked.shards);
}

constexpr std::string_view kShell = "#!/bin/sh\n";

/// The lines of a script that have an effect, i.e. all but comments. Slurm's #SBATCH lines count as
/// comments.
std::string commands_of(const std::string& script) {
    std::string out;
    std::istringstream lines(script);
    for (std::string line; std::getline(lines, line);) {
        const bool first = out.empty() && line.starts_with("#!");
        if (first || (!line.empty() && !line.starts_with('#'))) out += line + "\n";
    }
    return out;
}

/// Whether the folder contains a script for these shards, possibly with added #SBATCH lines. A
/// script that does anything else must not be submitted unread, because the folder may come from a
/// stranger.
bool has_script(const std::string& folder, const Asked& asked) {
    const std::string script = slurm_script(folder);
    return is_there(script) &&
           commands_of(read_text_file(script)) == std::string(kShell) + task_line(asked);
}

std::string by_sbatch(const std::string& folder, const Asked& asked,
                      const std::vector<int>& shards) {
    const bool all = static_cast<int>(shards.size()) == asked.shards;
    return fmt::format("sbatch {}{}", all ? "" : fmt::format("--array={} ", fmt::join(shards, ",")),
                       shell_file(slurm_script(folder)));
}

std::string by_hand(const Asked& asked, const std::vector<int>& shards) {
    if (asked.shards == 1) return asked.command;
    if (shards.size() == 1)
        return fmt::format("{} --shard {}/{}", asked.command, shards[0], asked.shards);
    return fmt::format("parallel -q {} --shard {{}}/{} ::: {}", asked.command, asked.shards,
                       fmt::join(shards, " "));
}

}  // namespace

std::string slurm_script(const std::string& folder) {
    return folder + "/slurm.sh";
}

void write_slurm_script(const std::string& folder, const Asked& asked) {
    const fs::path whole = fs::absolute(folder).lexically_normal();
    make_folders(folder, "slurm");  // Slurm does not create the folder of its logs
    if (has_script(folder, asked)) return;
    write_file(
        fmt::format("{3}"
                    "# A rehearsal in {0} shards, each of which is a task of a Slurm array.\n"
                    "# To submit all of them:         sbatch slurm.sh\n"
                    "# To submit only the third one:  sbatch --array=3 slurm.sh\n"
                    "# Completed people are not repeated. If your cluster requires an account, a\n"
                    "# partition or a time limit, add it below, in lines that begin with #SBATCH.\n"
                    "#SBATCH --job-name=dihaptic\n"
                    "#SBATCH --array=1-{0}\n"
                    "#SBATCH --ntasks=1\n"
                    "#SBATCH --cpus-per-task=1\n"
                    "#SBATCH --output=\"{1}/slurm/%a.log\"\n"
                    "{2}",
                    asked.shards, sbatch_name(whole.string()), task_line(asked), kShell),
        slurm_script(folder));
}

std::optional<std::string> submit(const std::string& folder, const Asked& asked,
                                  const std::vector<int>& shards) {
    constexpr int kNotFound = 127;
    std::string command = by_sbatch(folder, asked, shards);
    command.insert(command.find(' '), " --parsable");
    command = fmt::format("command -v sbatch >/dev/null || exit {}; {}", kNotFound, command);
    std::fflush(nullptr);
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) {
        throw Error(fmt::format("cannot start sbatch: {}", std::strerror(errno)),
                    "End other programs and try again.");
    }
    std::string said;
    for (int letter = 0; (letter = std::fgetc(pipe)) != EOF;) said += static_cast<char>(letter);
    const int status = pclose(pipe);
    if (status != 0) {
        const bool none = WIFEXITED(status) && WEXITSTATUS(status) == kNotFound;
        const std::string again = by_sbatch(folder, asked, shards);
        if (none) {
            fmt::print(stderr,
                       "not submitted: this machine has no sbatch. On one that has it, type\n"
                       "{}\n"
                       "or, to do it here without Slurm,\n"
                       "{}\n"
                       "next, when it has ended: dihaptic collect {}\n",
                       again, by_hand(asked, shards), shell_file(folder));
        } else {
            print({{Severity::error,
                    {slurm_script(folder), 0},
                    "",
                    "is refused by sbatch, whose reason is printed above",
                    "Solve this problem, then type the command below."}});
            fmt::print(stderr, "{}\n", again);
        }
        exit_code = kBadInput;
        return std::nullopt;
    }
    return said.substr(0, said.find_first_of(";\n"));  // sbatch prints "123" or "123;cluster"
}

std::string command_for(const std::string& folder, const Asked& asked,
                        const std::vector<int>& shards) {
    return has_script(folder, asked) ? by_sbatch(folder, asked, shards) : by_hand(asked, shards);
}

}  // namespace dihaptic::cli
