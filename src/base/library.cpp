#include "base/library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>

namespace dihaptic {

Library::Library(Spec spec, const std::string& path, Place place)
    : spec_(std::move(spec)), place_(std::move(place)) {
    if (!path.empty()) spec_.files = {path};
    std::vector<std::string> said;
    std::string remedy = spec_.remedy;
    for (const std::string& file : spec_.files) {
        handle_ = dlopen(file.c_str(), RTLD_LAZY | (spec_.global ? RTLD_GLOBAL : RTLD_LOCAL));
        if (handle_ != nullptr) break;
        std::string why = dlerror();
        for (const Spec::Need& need : spec_.needs) {
            if (why.starts_with(need.file)) remedy = need.remedy;
        }
        if (why.starts_with(file + ": ")) why.erase(0, file.size() + 2);
        said.push_back(fmt::format("{} ({})", file, why));
    }
    if (handle_ == nullptr) {
        throw Error(
            place_, "library",
            fmt::format("{} cannot be loaded; tried {}", spec_.product, fmt::join(said, ", ")),
            remedy);
    }
    link_map* map = nullptr;
    if (dlinfo(handle_, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr) file_ = map->l_name;
}

void* Library::address(const char* symbol) const {
    void* const found = dlsym(handle_, symbol);
    if (found != nullptr) return found;
    throw Error(place_, "library", fmt::format("{} has no {}", file_, symbol),
                "This program does not support its version. " + spec_.remedy);
}

}  // namespace dihaptic
