#include "common/console.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "base/installed.h"
#include "base/text.h"

namespace dihaptic::cli {

std::atomic<bool> stop_requested{false};
int exit_code = kOk;

namespace {

/// Writes to standard error. Write errors are ignored: if the terminal is closed, the session still
/// finishes, without showing progress.
void say(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::show(double share, const std::string& what) {
    const int percent = static_cast<int>(share * 100);
    if (!terminal_) {
        if (percent / 10 == shown_ / 10 && shown_ >= 0) return;
        shown_ = percent;
        say(fmt::format("{} {:3d} % {}\n", label_, percent, what));
        return;
    }
    constexpr int kBar = 24;
    const int full = percent * kBar / 100;
    std::string line =
        fmt::format("{} [{:<{}}] {:3d} % {}", label_, std::string(static_cast<size_t>(full), '#'),
                    kBar, percent, what);
    const size_t width = line.size();
    if (width < width_) line.append(width_ - width, ' ');
    width_ = width;
    say("\r" + line);
}

void ProgressLine::show_or_stop(double share, const std::string& what) {
    if (stop_requested) throw Interrupted{};
    show(share, what);
}

void ProgressLine::clear() {
    if (terminal_ && width_ > 0) say(fmt::format("\r{:{}}\r", "", width_));
    width_ = 0;
}

void print(const std::vector<Problem>& problems, std::FILE* to) {
    for (const Problem& problem : problems) fmt::print(to, "{}\n", problem.text());
}

namespace {

template <class Number>
CLI::Validator range(Number low, Number high, const char* kind) {
    const auto check = [=](const std::string& text) {
        Number value{};
        const char* const last = text.data() + text.size();
        const auto [end, status] = std::from_chars(text.data(), last, value);
        // NaN fails these comparisons too
        if (status == std::errc() && end == last && value >= low && value <= high)
            return std::string();
        return fmt::format("must be a {} from {} to {}, is '{}'", kind, low, high, text);
    };
    return {check, fmt::format("{} to {}", low, high)};
}

}  // namespace

CLI::Validator rate_range() {
    return range(100.0, 10000.0, "number");
}

CLI::Validator time_range() {
    return range(1.0, 3600.0, "number");
}

CLI::Validator given_or_kept() {
    return {[](std::string& name) {
                name = dihaptic::given_or_kept(name);
                return std::string();
            },
            ""};
}

CLI::Validator seed_range() {
    return range(uint64_t{0}, std::numeric_limits<uint64_t>::max(), "whole number");
}

void add_json(CLI::App& command, bool& json) {
    command.add_flag("--json", json, "one JSON object on standard output, nothing else");
}

namespace {

/// Throws an Error that names the word that is not a command, because the parser's own message
/// would not name it.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (command->get_name() == argv[1]) return;
        commands.push_back(command->get_name());
    }
    const std::string guess = nearest(argv[1], commands);
    throw Error(
        fmt::format("'{}' is not a command", argv[1]),
        (guess.empty() ? fmt::format("Commands are {}.", fmt::join(commands, ", "))
                       : fmt::format("Did you mean {}?", guess)) +
            fmt::format(" See {} --help.", std::filesystem::path(argv[0]).filename().string()));
}

/// Checks the command line and the current folder, because both are recorded. Throws Error when
/// they could not be read back from the recording.
void check_typed(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) check_text(argv[i], fmt::format("command line, word {}", i));
    if (argc < 2 || argv[1][0] == '-') return;
    std::error_code gone;
    check_text(std::filesystem::current_path(gone).string(), "the current folder");
}

/// The command with its files, as shown in a message.
std::string what_is_done(int argc, char** argv) {
    std::string out = std::filesystem::path(argv[0]).filename().string();
    for (int i = 1; i < argc; ++i) out += std::string(" ") + argv[i];
    return out;
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv) {
    app.require_subcommand(1);
    try {
        check_typed(argc, argv);
        refuse_unknown_command(app, argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const int code = app.exit(e);
        return code == 0 ? kOk : kBadInput;
    } catch (const Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return stop_requested ? kFailed : kBadInput;  // the user gave up waiting
    } catch (const Interrupted&) {
        fmt::print(stderr, "interrupted: nothing more was written\n");
        return kFailed;
    } catch (const std::filesystem::filesystem_error& e) {
        fmt::print(stderr, "{}: error: {}. Check the file and its permissions.\n",
                   e.path1().string(), e.code().message());
        return kBadInput;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr,
                   "error: {} requires more memory than is available. Close other programs, use "
                   "smaller files, or allow more (ulimit -v).\n",
                   what_is_done(argc, argv));
        return kFailed;
    } catch (const std::exception& e) {
        fmt::print(stderr, "error: {}. Please report this, with the command that you typed.\n",
                   e.what());
        return kFailed;
    }
    return exit_code;
}

}  // namespace dihaptic::cli
