#include "link_socket.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

bool ilk_unix_address(const char *path, struct sockaddr_un *address, ilk_error_t *error) {
  *address = (struct sockaddr_un){.sun_family = AF_UNIX};
  const size_t length = strlen(path);
  if (length == 0u || length >= sizeof address->sun_path) {
    return ilk_fail(error,
                    "socket path '%s' has %zu characters; expected 1 to %zu; choose a shorter directory",
                    path, length, sizeof address->sun_path - 1u);
  }
  (void)memcpy(address->sun_path, path, length + 1u);
  return true;
}

/** Two kernels that start together must not take each other's socket for a stale one. */
static int lock_directory(const char *path) {
  char copy[sizeof(struct sockaddr_un)];
  (void)memcpy(copy, path, strlen(path) + 1u);
  const int directory = open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0 && flock(directory, LOCK_EX) != 0) {
    (void)close(directory);
    return -1;
  }
  return directory;
}

/**
 * A probe of another socket type never reaches the accept queue: it is refused with EPROTOTYPE by a
 * living socket and with ECONNREFUSED by a stale one.
 */
static bool is_served(const struct sockaddr_un *address) {
  const int probe = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool stale = probe >= 0 && connect(probe, (const struct sockaddr *)address, sizeof *address) != 0 &&
                     errno == ECONNREFUSED;
  if (probe >= 0) {
    (void)close(probe);
  }
  return !stale;
}

static ilk_listen_result_t remove_stale(const struct sockaddr_un *address, ilk_error_t *error) {
  struct stat status;
  if (lstat(address->sun_path, &status) != 0) {
    return ILK_LISTEN_OK;
  }
  if (!S_ISSOCK(status.st_mode)) {
    (void)ilk_fail(error, "link '%s' exists and is not a socket; remove it or choose another path",
                   address->sun_path);
    return ILK_LISTEN_FAILED;
  }
  if (is_served(address)) {
    (void)ilk_fail(error, "link '%s' is served by a running kernel; stop it or choose another path",
                   address->sun_path);
    return ILK_LISTEN_TAKEN;
  }
  if (unlink(address->sun_path) != 0) {
    (void)ilk_fail(error, "stale link '%s' cannot be removed: %s", address->sun_path, strerror(errno));
    return ILK_LISTEN_FAILED;
  }
  return ILK_LISTEN_OK;
}

static bool bind_and_listen(ilk_link_socket_t *link, ilk_error_t *error) {
  const char *path = link->address.sun_path;
  struct stat status;
  link->descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (link->descriptor < 0) {
    return ilk_fail(error, "cannot create the link's socket: %s", strerror(errno));
  }
  const mode_t mask = umask(S_IXUSR | S_IRWXG | S_IRWXO);
  const int bound = bind(link->descriptor, (const struct sockaddr *)&link->address, sizeof link->address);
  const int reason = errno;
  (void)umask(mask);
  if (bound != 0) {
    (void)close(link->descriptor);
    return ilk_fail(error, "cannot bind link '%s': %s", path, strerror(reason));
  }
  if (listen(link->descriptor, 8) != 0 || stat(path, &status) != 0) {
    const int cause = errno;
    (void)close(link->descriptor);
    (void)unlink(path);
    return ilk_fail(error, "cannot listen on link '%s': %s", path, strerror(cause));
  }
  link->device = status.st_dev;
  link->inode = status.st_ino;
  return true;
}

ilk_listen_result_t ilk_link_listen(ilk_link_socket_t *link, const char *path, ilk_error_t *error) {
  if (!ilk_unix_address(path, &link->address, error)) {
    return ILK_LISTEN_FAILED;
  }
  const int directory = lock_directory(path);
  if (directory < 0) {
    (void)ilk_fail(error, "cannot open the directory of link '%s': %s; create it first", path,
                   strerror(errno));
    return ILK_LISTEN_FAILED;
  }
  ilk_listen_result_t result = remove_stale(&link->address, error);
  if (result == ILK_LISTEN_OK && !bind_and_listen(link, error)) {
    result = ILK_LISTEN_FAILED;
  }
  (void)close(directory);
  return result;
}

bool ilk_link_share(const ilk_link_socket_t *link, ilk_error_t *error) {
  const char *path = link->address.sun_path;
  return chmod(path, S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) == 0 ||
         ilk_fail(error, "link '%s' cannot be shared with its group: %s", path, strerror(errno));
}

void ilk_link_unlisten(ilk_link_socket_t *link) {
  struct stat status;
  if (lstat(link->address.sun_path, &status) == 0 && status.st_dev == link->device &&
      status.st_ino == link->inode) {
    (void)unlink(link->address.sun_path);
  }
  (void)close(link->descriptor);
  link->descriptor = -1;
}
