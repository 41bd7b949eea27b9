#include "task_texts.h"

#include <algorithm>

#include "frame/shown_texts.h"

namespace dihaptic::gui {
namespace {

/// The texts that the task currently shows, one per line.
QString texts_of(const session::Plan& plan, const frame::Frame& frame) {
    QStringList out;
    if (plan.task) {
        for (const std::string& text : frame::shown_texts(frame.task, plan.task->messages))
            out += QString::fromStdString(text);
    }
    return out.join("\n");
}

/// The part of the answer that has been typed: the number at the end of the line that shows the
/// scale in words. `scale`: index of that line's message.
QString typed_in(const frame::TaskFrame& task, const task::TaskPlan& plan, int scale) {
    const std::vector<std::string> texts = frame::shown_texts(task, plan.messages);
    for (size_t i = 0; i < task.lines.size(); ++i) {
        if (task.lines[i].message != scale) continue;
        const std::string& line = texts[i + (task.message >= 0 ? 1 : 0)];
        const std::string number = line.substr(line.rfind(' ') + 1);
        return number == "-" ? "" : QString::fromStdString(number);
    }
    return "";
}

}  // namespace

bool TaskTexts::follow(const session::Plan& plan, const frame::Frame& frame) {
    const QString said = texts_of(plan, frame);
    if (said == said_ && page_ == frame.task.page) return false;
    said_ = said;
    page_ = frame.task.page;
    return true;
}

TaskTexts::Words TaskTexts::words(const session::Plan& plan) const {
    if (page_ < 0) return {said_, "", ""};
    const task::TaskPlan::Page& page = plan.task->pages[static_cast<size_t>(page_)];
    return {"", said_, QString::fromStdString(page.spec.picture)};
}

std::optional<Asked> asked_in(const frame::Frame& frame, const task::TaskPlan& plan) {
    if (frame.trial < 1 || frame.phase < 1 || frame.task.outcome >= 0) return {};
    const auto phase = static_cast<size_t>(frame.phase) - 1;
    const task::State& state = plan.task.states[phase];
    Asked out;
    out.items = state.questions();
    out.is_form = state.form.has_value();
    if (out.items.empty()) return {};
    if (!out.is_form && out.items.front().by != task::AnswerBy::mouse) return {};
    if (out.is_form)
        out.title =
            QString::fromStdString(state.message.empty() ? state.form->title : state.message);
    // the lines below the message say which question is being asked
    const auto& items = plan.states[phase].questions.items;
    const auto is_shown = [&](const task::TaskPlan::Questions::Item& item) {
        return std::ranges::any_of(frame.task.lines, [&](const frame::LineFrame& line) {
            return line.message == item.lines.front();
        });
    };
    out.now = static_cast<size_t>(std::ranges::find_if(items, is_shown) - items.begin());
    for (const auto& item : items)
        out.answers.push_back(frame.task.variables[item.question.variable].value /
                              item.question.si);
    if (out.now < items.size()) out.typed = typed_in(frame.task, plan, items[out.now].lines.back());
    return out;
}

}  // namespace dihaptic::gui
