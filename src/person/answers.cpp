#include "person/answers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace dihaptic::person {
namespace {

using task::TaskPlan;
using task::When;

constexpr double kDecision = 0.4;  // time to decide on an answer, after the reaction time [s]

/// Whether the state waits for a key press.
bool asks(const TaskPlan::PlannedState& planned) noexcept {
    return std::any_of(planned.transitions.begin(), planned.transitions.end(),
                       [](const TaskPlan::Transition& transition) {
                           return transition.exit.when == When::key ||
                                  transition.exit.when == When::answered;
                       });
}

/// The keys for which the state waits: the first means yes, and the second, if there is one, no.
char key_for(const TaskPlan::PlannedState& state, bool yes) noexcept {
    char first = 0;
    char second = 0;
    for (const TaskPlan::Transition& transition : state.transitions) {
        if (transition.exit.when != When::key) continue;
        if (first == 0) {
            first = transition.exit.key.front();
        } else if (second == 0) {
            second = transition.exit.key.front();
        }
    }
    return yes || second == 0 ? first : second;
}

}  // namespace

void Answers::restart() noexcept {
    at_ = -1;
    key_ = 0;
    typed_at_ = typed_length_ = 0;
}

void Answers::enter(const TaskPlan::PlannedState& state, double decides) noexcept {
    at_ = asks(state) ? decides + kDecision : -1;
    rated_ = 0;
}

void Answers::answer(const Traits& traits, const TaskPlan::PlannedState& state,
                     const SeenAndFelt& hand, double now, Random& random) noexcept {
    at_ = -1;
    const TaskPlan::Questions& questions = state.questions;
    if (!questions.items.empty() && questions.items.front().question.by != task::AnswerBy::cursor)
        return rate(questions, now, random);
    const double felt = (hand.felt - from_.felt).norm();
    const double shown = (hand.shown - from_.shown).norm();
    const double evidence = felt > 0 && shown > 0 ? std::log(shown / felt) : 0;
    key_ = key_for(state, random.uniform(0, 1) < traits.answers().probability(evidence));
}

/// Types the simulated answer to the next question. Because there is no model of ratings, the
/// default is a random whole number on the question's scale. After the last question of a form,
/// presses Enter.
void Answers::rate(const TaskPlan::Questions& questions, double now, Random& random) noexcept {
    if (rated_ == questions.items.size()) {
        key_ = task::Rating::kEnter;
        return;
    }
    const task::Question& question = questions.items[rated_++].question;
    if (questions.is_form) at_ = now + kDecision;
    const double most = question.most < task::kMostMagnitude ? question.most : question.least + 100;
    const double drawn = std::clamp(std::ceil(random.uniform(question.least - 1, std::floor(most))),
                                    question.least, most);
    const auto end = std::to_chars(typed_.data(), typed_.data() + task::Rating::kLongest,
                                   question.simulated.value_or(drawn), std::chars_format::fixed)
                         .ptr;
    *end = task::Rating::kEnter;
    typed_length_ = static_cast<size_t>(end - typed_.data()) + 1;
    typed_at_ = 0;
}

char Answers::take_key() noexcept {
    if (typed_at_ < typed_length_) return typed_[typed_at_++];
    return std::exchange(key_, '\0');
}

}  // namespace dihaptic::person
