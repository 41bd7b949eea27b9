#include "study/key_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/descriptor.h"
#include "base/figure.h"
#include "base/table.h"
#include "base/text_file.h"
#include "rows/row_file.h"

namespace dihaptic::study {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kOthers = 0077;

/// Whether the file is in the folder or in one of its subfolders.
bool is_in(const std::string& file, const std::string& folder) {
    const fs::path inner = fs::weakly_canonical(fs::absolute(file));
    const fs::path outer = fs::weakly_canonical(fs::absolute(folder));
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first ==
           outer.end();
}

}  // namespace

KeyFile::KeyFile(const StudyFile& study, std::string file, Missing missing)
    : file_(std::move(file)) {
    if (file_.empty())
        throw Error({"--key", 0}, "", "names no file", "Name the file that contains the names.");
    if (is_in(file_, study.data)) {
        throw Error({file_, 0}, "", "is in the study's folder, and would be shared with the data",
                    "Keep names elsewhere, e.g. on an encrypted disk.");
    }
    struct stat there {};
    if (::stat(file_.c_str(), &there) != 0) {
        if (missing == Missing::is_refused)
            throw Error({file_, 0}, "", "does not exist", "Name the file that contains the names.");
        check_output(file_, "", "");
        return;
    }
    if (!S_ISREG(there.st_mode))
        throw Error({file_, 0}, "", "is not a file", "Name the file that contains the names.");
    if ((there.st_mode & kOthers) != 0) {
        throw Error({file_, 0}, "", "contains names, but others can read it",
                    fmt::format("Run: chmod 600 {}", file_));
    }
    const rows::RowFile<Key> table(file_);
    for (const Table::Column& column : figure_table<Key>(keys_).columns) {
        if (table.column(column.name)) continue;
        throw Error({file_, 1}, column.name, "is missing as a column, so this is not a key file",
                    "Name another file, which is made if it does not exist.");
    }
    keys_.assign(table.begin(), table.end());
}

const Key* KeyFile::find(const std::string& participant) const {
    const auto found = std::ranges::find(keys_, participant, &Key::participant);
    return found == keys_.end() ? nullptr : &*found;
}

void KeyFile::add(const Key& key) {
    if (const Key* const known = find(key.participant)) {
        if (known->name == key.name && known->contact == key.contact) return;
        throw Error({file_, 0}, key.participant, "already belongs to another name",
                    "Choose another identifier, or correct the file.");
    }
    keys_.push_back(key);
    write();
}

bool KeyFile::remove(const std::string& participant) {
    if (find(participant) == nullptr) return false;
    std::erase_if(keys_, [&](const Key& key) { return key.participant == participant; });
    write();
    return true;
}

void KeyFile::write() const {
    // only the owner can access a new file, even before it contains names; replacing it keeps this
    if (!fs::exists(file_)) {
        const Descriptor made(::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
        if (!made)
            throw Error({file_, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                        "Name a file in an existing folder that you can write to.");
    }
    write_file(to_csv(figure_table<Key>(keys_)), file_, Keep::at_once);
}

}  // namespace dihaptic::study
