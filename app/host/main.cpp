// dihaptic-host: owns the real devices of a session, in a separate process (src/host). The program
// dihaptic starts this program; there is no need to call it by hand.
#include <sys/stat.h>

#include <cstdio>

#include "host/host.h"
#include "servo/real_time.h"

int main(int count, char**) {
    struct stat socket {};
    if (count != 1 || fstat(dihaptic::host::kSocket, &socket) != 0 || !S_ISSOCK(socket.st_mode)) {
        std::fputs("dihaptic-host is started by dihaptic, for real devices\n", stderr);
        return 2;
    }
    return dihaptic::host::keep([](int priority, const std::function<void()>& body) {
        const dihaptic::servo::RealTime real_time(priority);
        body();
    });
}
