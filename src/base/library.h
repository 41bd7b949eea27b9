// A third-party library is loaded when a rig needs it. The program runs without it, and reports
// a missing library with the paths tried and the remedy.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

class Library {
  public:
    struct Spec {
        std::string product;             ///< for messages
        std::vector<std::string> files;  ///< tried in this order; dlopen() looks for them
        bool global = false;             ///< whether libraries loaded by it see its symbols
        std::string remedy;              ///< the package to install
        /// A library that this one needs: the start of its file name, and the package that
        /// contains it.
        struct Need {
            std::string file;
            std::string remedy;
        };
        std::vector<Need> needs;
    };

    /// Loads `path` or, if that is empty, the first of the spec's files that can be loaded. The
    /// library is never unloaded: such libraries start threads that outlive their last call. Throws
    /// Error for `place` with the loader's message for each file.
    Library(Spec spec, const std::string& path, Place place);

    /// The file that was loaded.
    const std::string& file() const { return file_; }

    /// Sets `function` to the library's symbol. Throws Error when the library lacks it.
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
