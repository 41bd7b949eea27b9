#include "session/listeners/sight.h"

#include "session/plan.h"
#include "task/run/task_director.h"

namespace dihaptic::session {
namespace {

class Sight : public Listener {
  public:
    explicit Sight(const Plan& plan) : plan_(plan) { plan.seeing->restart(); }

    void steer(const Steering& steering) noexcept override {
        if (steering.task == nullptr) return;
        if (const char key = plan_.seeing->take_key(); key != 0) steering.task->press(key);
        // a simulated person turns a page once per second
        const int page = steering.last.task.page;
        if (page >= 0 && steering.is_once_a_second())
            steering.task->press(plan_.task->pages[static_cast<size_t>(page)].any_key());
    }
    void take(const frame::Frame& frame) noexcept override { plan_.seeing->see(frame); }

  private:
    const Plan& plan_;
};

}  // namespace

std::unique_ptr<Listener> show_to_person(const Opening& opening) {
    if (!opening.plan.seeing) return nullptr;
    return std::make_unique<Sight>(opening.plan);
}

}  // namespace dihaptic::session
