// Forms: a state shows several questions on one page, such as a questionnaire or a consent form,
// and the answers may be changed until the page is confirmed. A form is usually stored in its own
// file.
#pragma once

#include <string>
#include <vector>

#include "task/file/rating.h"

namespace dihaptic::task {

/// A number computed from the answers.
struct Score {
    std::string name;  ///< name of the score, which may end in its unit
    std::string of;    ///< expression over the answers
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the score, which may end in its unit."));
        v("of", of, Field::text().required().says("Expression over the answers."));
    }
};

/// A form file.
struct Form {
    std::string title;
    std::string version;
    std::string source;  ///< publication
    std::vector<AskSpec> items;
    std::vector<Score> scores;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, says("Title, shown above the items."));
        v("version", version, says("Version, which is recorded with each answer."));
        v("source", source, says("Publication of the questionnaire."));
        v("items", items, says("Questions, in order."));
        v("scores", scores, says("Numbers computed from the answers, in columns of trials.csv."));
    }
};

/// The form that a state shows.
struct FormSpec : Form {
    std::string file;  ///< path of the form file, relative to the experiment file

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file,
          says("Form file, in place of the other keys; the search order is the same as for "
               "'scene'. A session stores its contents."));
        Form::visit(v);
    }

    /// Reads the form file, if `file` names one, and then clears `file`. Relative paths start at
    /// `folder`.
    void read_file(const std::string& folder, Diagnostics& diagnostics);
};

/// Reads a form file. Throws Error if the file cannot be read; other problems are added to
/// `diagnostics`.
Form read_form(const std::string& file, Diagnostics& diagnostics);
/// Checks the form by itself. Problems are added to `diagnostics`.
void check(const Form& form, Diagnostics& diagnostics);

}  // namespace dihaptic::task
