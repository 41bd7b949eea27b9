#include "base/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/diagnostics.h"

namespace dihaptic {

TemporaryFolder::TemporaryFolder()
    : path_((std::filesystem::temp_directory_path() / "dihaptic-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) {
        throw Error("no temporary folder can be made: " + std::string(std::strerror(errno)),
                    "Free some disk space, or set TMPDIR to a writable folder.");
    }
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace dihaptic
