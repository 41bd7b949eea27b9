#include "task/run/answering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/unmeasured.h"

namespace dihaptic::task {

void Answering::begin(const TaskPlan::Questions& questions) noexcept {
    questions_ = &questions;
    answers_.fill(kUnmeasured);
    given_.fill(false);
    confirmed_ = false;
    ended_itself_ = false;
    item_ = 0;
    rating_.begin();
}

std::span<const int> Answering::lines() const noexcept {
    if (count() == 0) return {};
    return item_ < count() ? questions_->items[item_].lines : questions_->confirm;
}

bool Answering::answered() const noexcept {
    if (questions_ == nullptr || questions_->items.empty()) return false;
    return questions_->is_form ? confirmed_ : !std::isnan(answers_[0]);
}

void Answering::give(size_t item, double answer) noexcept {
    answers_[item] = answer;
    given_[item] = true;
    if (questions_->is_form && item == item_) ask_next();
}

void Answering::ask_next() noexcept {
    const auto end = given_.begin() + static_cast<ptrdiff_t>(count());
    item_ = static_cast<size_t>(std::find(given_.begin(), end, false) - given_.begin());
    rating_.begin();
}

void Answering::reopen(size_t item) noexcept {
    answers_[item] = kUnmeasured;
    given_[item] = false;
    ask_next();
}

void Answering::press(char key) noexcept {
    if (key == 0 || count() == 0) return;
    const bool superfluous = std::exchange(ended_itself_, false) && key == Rating::kEnter;
    if (superfluous && questions_->is_form) return;
    const bool back = key == Rating::kBack && rating_.empty() && questions_->is_form;
    if (back && item_ > 0) return reopen(item_ - 1);
    if (item_ == count()) {
        confirmed_ |= key == Rating::kEnter;
        return;
    }
    const Question& question = questions_->items[item_].question;
    if (key == Rating::kEnter && rating_.empty() && question.optional)
        return give(item_, kUnmeasured);
    rating_.press(key, question);
    if (std::isnan(rating_.answer())) return;
    ended_itself_ = key != Rating::kEnter;
    give(item_, rating_.answer());
}

void Answering::click(const Click& click) noexcept {
    if (click.item < 0 || count() == 0) return;
    const auto item = static_cast<size_t>(click.item);
    if (item >= count()) {
        confirmed_ |= questions_->is_form && item_ == count();
        return;
    }
    const Question& question = questions_->items[item].question;
    if (question.by != AnswerBy::mouse || (!questions_->is_form && given_[item])) return;
    Rating clicked;
    clicked.click(click.share(), question);
    if (item == item_) rating_ = clicked;
    give(item, clicked.answer());
}

void Answering::point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W) noexcept {
    rating_.point(p_W, from_W, to_W, questions_->items.front().question);
    answers_[0] = rating_.answer();
}

}  // namespace dihaptic::task
