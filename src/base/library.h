// A library of somebody else's, loaded when a rig asks for it: the program runs without, and says
// what is missing, where it was sought and what mends it.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

class Library {
  public:
    struct Spec {
        std::string product;             ///< for messages
        std::vector<std::string> files;  ///< tried in this order, as dlopen() seeks them
        bool global = false;             ///< whether libraries that it loads itself see its symbols
        std::string remedy;              ///< what to install
        /// A library that this one needs, by the beginning of its name, and what has it.
        struct Need {
            std::string file;
            std::string remedy;
        };
        std::vector<Need> needs;
    };

    /// Loads the first file that can be, or only `path` if there is one. It stays loaded for good:
    /// such libraries start threads, which outlive their last call. Throws Error for `place` with
    /// what was said of each file.
    Library(Spec spec, const std::string& path, Place place);

    /// The file that was loaded.
    const std::string& file() const { return file_; }

    /// Sets `function` to the library's symbol. Throws Error when it has none.
    template <class Function>
    void find(const char* symbol, Function*& function) const {
        function = reinterpret_cast<Function*>(address(symbol));
    }

  private:
    void* address(const char* symbol) const;

    Spec spec_;
    Place place_;
    void* handle_ = nullptr;
    std::string file_;
};

}  // namespace dihaptic
