// What a person knows about each body of the scene.
#pragma once

#include <string>
#include <vector>

#include "person/grip_memory.h"
#include "person/learned.h"

namespace dihaptic::person {

class BodyMemories {
  public:
    /// Adds the next body of the scene. `looks`: the properties that its appearance suggests.
    void add(const std::string& name, const GripMemory& looks) {
        bodies_.push_back({name, looks, looks});
    }

    /// Forgets everything except what `before` holds for bodies that have the same names and look
    /// equally heavy.
    void restart(const std::vector<Learned::OfBody>& before) noexcept;
    /// What the person will retain overnight, for each body.
    std::vector<Learned::OfBody> overnight() const;

    GripMemory& of(int body) noexcept { return bodies_[static_cast<size_t>(body)].known; }
    const GripMemory& of(int body) const noexcept {
        return bodies_[static_cast<size_t>(body)].known;
    }
    const GripMemory& looks(int body) const noexcept {
        return bodies_[static_cast<size_t>(body)].looks;
    }

  private:
    struct Body {
        std::string name;
        GripMemory looks;
        GripMemory known;
    };
    std::vector<Body> bodies_;
};

}  // namespace dihaptic::person
