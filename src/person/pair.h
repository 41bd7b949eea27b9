// Two simulated people who do a task together, each with one hand. Each sees and feels only their
// own hand.
#pragma once

#include <memory>

#include "task/run/seeing_driver.h"

namespace dihaptic::person {

class Pair final : public task::SeeingDriver {
  public:
    /// `second_finger`: index of the second person's first finger.
    Pair(std::shared_ptr<task::SeeingDriver> first, std::shared_ptr<task::SeeingDriver> second,
         size_t second_finger)
        : first_(std::move(first)), second_(std::move(second)), second_finger_(second_finger) {}

    double duration() const override { return first_->duration(); }
    const std::vector<Phase>& phases() const override { return first_->phases(); }
    void restart() override {
        first_->restart();
        second_->restart();
    }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        const bool of_second = static_cast<size_t>(finger) >= second_finger_;
        return (of_second ? *second_ : *first_).target(finger, t);
    }
    void do_see(const frame::Frame& frame) noexcept override {
        first_->see(frame);
        second_->see(frame);
    }
    /// The first person answers questions for both.
    char do_take_key() noexcept override {
        second_->take_key();
        return first_->take_key();
    }

    std::shared_ptr<task::SeeingDriver> first_;
    std::shared_ptr<task::SeeingDriver> second_;
    size_t second_finger_;
};

}  // namespace dihaptic::person
