#include "task/file/form.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/field_reader.h"
#include "base/installed.h"
#include "base/named_file.h"

namespace dihaptic::task {

void FormSpec::read_file(const std::string& folder, Diagnostics& diagnostics) {
    if (file.empty()) return;
    if (!items.empty() || !scores.empty() || !title.empty() || !version.empty()) {
        diagnostics.error(place, "file", "is given together with the form itself",
                          "Leave out one or the other.");
        return;
    }
    const std::string path = named_in(folder, file);
    try {
        check_named(path, place, "file");
        const Place here = place;
        static_cast<Form&>(*this) = read_form(path, diagnostics);
        place = here;
        file.clear();
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
}

Form read_form(const std::string& file, Diagnostics& diagnostics) {
    Form form;
    read_fields(form, read_yaml(file), diagnostics);
    form.place = {file, 1};
    return form;
}

void check(const Form& form, Diagnostics& diagnostics) {
    if (form.items.empty())
        diagnostics.error(form.place, "items", "is missing: the form asks nothing",
                          "Add e.g. items: [{ name: effort, question: \"How hard was it?\", scale: "
                          "vas, labels: [not at all, very] }], or name a form's file.");
    for (size_t i = 0; i < form.items.size(); ++i) {
        const AskSpec& item = form.items[i];
        check(item, diagnostics);
        if (item.question.empty())
            diagnostics.error(item.place, "question", "is missing",
                              "Write what is asked, e.g. question: How hard was it?");
        if (item.by == AnswerBy::cursor)
            diagnostics.error(item.place, "by", "cannot be 'cursor' in a form",
                              "Use by: key or by: mouse, or a state with 'ask'.");
        const auto same = [&](const AskSpec& other) { return other.name == item.name; };
        if (std::count_if(form.items.begin(), form.items.end(), same) > 1)
            diagnostics.error(item.place, "name",
                              fmt::format("'{}' is the name of another item too", item.name),
                              "Give each item a name of its own.");
    }
}

}  // namespace dihaptic::task
