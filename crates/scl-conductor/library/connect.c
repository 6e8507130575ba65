// Connecting. Some connections are late or cut: what passes them goes through `scl simulate`.

#include "sim.h"

#include <fcntl.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

// Only sockets of files: those in the runtime folder.
static bool has_path(int socket, const struct sockaddr *address, socklen_t length) {
    const struct sockaddr_un *unix_address = (const struct sockaddr_un *)address;
    if (length <= offsetof(struct sockaddr_un, sun_path) || address->sa_family != AF_UNIX) return false;
    int type = 0;
    socklen_t size = sizeof type;
    getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size);
    return type == SOCK_STREAM && unix_address->sun_path[0] == '/';
}

EXPORT int connect(int socket, const struct sockaddr *address, socklen_t length) {
    int result = REAL(connect)(socket, address, length);
    if (result < 0 || !sim_takes_part() || !sim_tells_connections()) return result;
    if (!has_path(socket, address, length)) return result;
    char path[CONNECTION_PATH] = {0};
    size_t written = length - offsetof(struct sockaddr_un, sun_path);
    memcpy(path, ((const struct sockaddr_un *)address)->sun_path, written < sizeof path ? written : sizeof path - 1);
    int other = sim_tell_connection(socket, path);
    if (other < 0) return 0;
    // It takes the place of the socket, which `scl simulate` has now.
    long status = sim_call(SYS_fcntl, socket, F_GETFL), flags = sim_call(SYS_fcntl, socket, F_GETFD);
    sim_call(SYS_dup3, other, socket, (flags & FD_CLOEXEC) != 0 ? O_CLOEXEC : 0);
    sim_call(SYS_close, other);
    sim_call(SYS_fcntl, socket, F_SETFL, status);
    return 0;
}
