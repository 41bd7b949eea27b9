// A library that is not needed to build the program, and loaded while it runs when it is there.
#pragma once

#include <string>
#include <vector>

namespace dihaptic {

class SharedLibrary {
  public:
    /// Loads the first of `names` that the system finds; a name with a slash is a file. Throws
    /// Error with what was sought, why each could not be loaded, and `remedy`.
    SharedLibrary(const std::vector<std::string>& names, const std::string& remedy);
    ~SharedLibrary();
    SharedLibrary(SharedLibrary&& other) noexcept;
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    const std::string& name() const { return name_; }
    /// Finds a function by its name and its type as we declare it. Throws Error when it is missing.
    template <class F>
    void find(F*& function, const char* name) const {
        function = reinterpret_cast<F*>(address(name));
    }

  private:
    void* address(const char* name) const;

    std::string name_;
    std::string remedy_;
    void* handle_ = nullptr;
};

}  // namespace dihaptic
