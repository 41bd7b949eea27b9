// Problems in an input are reported with all that its author needs to correct them: file, line,
// key, mistake and remedy. Readers collect all the problems in a file before they give up.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace dihaptic {

enum class Severity { warning, error };

/// Where a value was written. An empty file means that it came from the program itself.
struct Place {
    std::string file;
    int line = 0;  ///< counted from 1; 0 stands for the file as a whole
    /// For a mapping: the line of each of its keys, where problems with that key are reported.
    std::shared_ptr<const std::map<std::string, int>> keys = nullptr;
};

/// A word that is allowed at a given place in a file.
struct Choice {
    std::string word;
    std::string what;  ///< a sentence about the word; may be empty
};

struct Problem {
    Severity severity = Severity::error;
    Place place;
    std::string key;     ///< the key or column that the problem is about; may be empty
    std::string what;    ///< the mistake
    std::string remedy;  ///< how to correct the problem
    /// For an unknown key or word: the known ones that may still be given.
    std::vector<Choice> choices = {};

    /// The problem in the form "file:line: error: key: what. remedy", without the parts that are
    /// empty.
    std::string text() const;
};

/// Thrown during set-up, but never during a tick. what() lists the problems, one per line.
class Error : public std::runtime_error {
  public:
    explicit Error(std::vector<Problem> problems);
    Error(const Place& place, std::string key, std::string what, std::string remedy);
    Error(std::string what, std::string remedy)
        : Error(Place{}, "", std::move(what), std::move(remedy)) {}

    const std::vector<Problem>& problems() const { return problems_; }

  private:
    std::vector<Problem> problems_;
};

/// How unknown keys are treated. In files that people write, an unknown key is a mistake. In files
/// that another version of this program wrote, it may be a key that only that version has.
enum class UnknownKeys { are_errors, are_left_out };

/// Collects problems while an input is read.
class Diagnostics {
  public:
    explicit Diagnostics(UnknownKeys unknown = UnknownKeys::are_errors) : unknown_(unknown) {}

    void error(const Place& place, std::string key, std::string what, std::string remedy,
               std::vector<Choice> choices = {});
    void warning(const Place& place, std::string key, std::string what, std::string remedy);
    UnknownKeys unknown_keys() const { return unknown_; }
    void unknown_key(const Place& place, std::string key, std::string remedy,
                     std::vector<Choice> choices = {});
    void add(const std::vector<Problem>& problems);

    const std::vector<Problem>& problems() const { return problems_; }
    bool has_errors() const;
    /// Throws Error with all the problems if at least one of them is an error.
    void throw_if_errors() const;

  private:
    UnknownKeys unknown_;
    std::vector<Problem> problems_;
};

/// The candidate with the smallest edit distance to `word`, or "" if no candidate is near enough to
/// be suggested.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace dihaptic
