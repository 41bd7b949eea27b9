#include "base/shared_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "base/diagnostics.h"

namespace dihaptic {

SharedLibrary::SharedLibrary(const std::vector<std::string>& names, const std::string& remedy)
    : remedy_(remedy) {
    std::vector<std::string> reasons;
    for (const std::string& name : names) {
        handle_ = dlopen(name.c_str(), RTLD_LAZY | RTLD_GLOBAL);
        if (handle_ != nullptr) {
            name_ = name;
            return;
        }
        if (const char* reason = dlerror()) reasons.emplace_back(reason);
    }
    throw Error(fmt::format("none of {} can be loaded ({})", fmt::join(names, ", "),
                            fmt::join(reasons, "; ")),
                remedy);
}

SharedLibrary::SharedLibrary(SharedLibrary&& other) noexcept
    : name_(std::move(other.name_)),
      remedy_(std::move(other.remedy_)),
      handle_(std::exchange(other.handle_, nullptr)) {}

SharedLibrary::~SharedLibrary() {
    if (handle_ != nullptr) dlclose(handle_);
}

void* SharedLibrary::address(const char* name) const {
    void* const found = dlsym(handle_, name);
    if (found == nullptr) throw Error(fmt::format("{} has no '{}'", name_, name), remedy_);
    return found;
}

}  // namespace dihaptic
