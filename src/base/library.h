// Loads a third-party library when a rig needs it. The program also runs without such a library; if
// a library is missing, it reports the paths that were tried and the remedy.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

class Library {
  public:
    struct Spec {
        std::string product;             ///< for messages
        std::vector<std::string> files;  ///< file names, tried in this order; dlopen() finds them
        bool global = false;             ///< whether libraries that it loads can see its symbols
        std::string remedy;              ///< the package to install
        /// Another library that this library needs: the start of its file name, and the package
        /// that contains it.
        struct Need {
            std::string file;
            std::string remedy;
        };
        std::vector<Need> needs;
    };

    /// Loads `path` or, if that is empty, the first of the spec's files that can be loaded. The
    /// library is never unloaded, because such libraries start threads that may still run after the
    /// last call. Throws Error at `place`, with the loader's message for each file.
    Library(Spec spec, const std::string& path, Place place);

    /// The path of the file that was loaded.
    const std::string& file() const { return file_; }

    /// Sets `function` to the library's symbol. Throws Error if the library does not have this
    /// symbol.
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
