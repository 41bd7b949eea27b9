#include "base/disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/descriptor.h"
#include "base/diagnostics.h"

namespace dihaptic {

void sync_to_disk(int descriptor, const std::string& name) {
    int status = ::fsync(descriptor);
    while (status != 0 && errno == EINTR) status = ::fsync(descriptor);
    if (status == 0 || errno == EINVAL || errno == ENOSYS || errno == EROFS) return;
    throw Error({name, 0}, "",
                fmt::format("cannot be written to the disk: {}", std::strerror(errno)),
                "Save your data elsewhere: the disk is full or failing.");
}

void sync_to_disk(const std::string& name) {
    const Descriptor descriptor(::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!descriptor) return;  // a file that cannot be read was not written by this program
    sync_to_disk(descriptor.get(), name);
}

std::string make_room(int error) {
    switch (error) {
        case EDQUOT:
            return "free some of your quota";
        case EFBIG:
            return "files cannot become so large there (4 GB on a FAT stick, or the limit of "
                   "'ulimit -f'"
                   "), so copy the folder to another disk";
        case EIO:
        case EROFS:
            return "the disk is failing, so copy the folder to another one";
        default:
            return "free some space";
    }
}

}  // namespace dihaptic
