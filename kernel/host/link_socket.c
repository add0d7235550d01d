#include "link_socket.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdint.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define LOCK_TRIES 100u
#define LOCK_PAUSE_NS 10000000

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

/**
 * Two kernels that start together must not take each other's socket for a stale one. Whoever may open the
 * directory can hold its lock, too; that is no reason not to start, so the wait for it ends.
 */
static int lock_directory(const char *path) {
  char copy[sizeof(struct sockaddr_un)];
  const struct timespec pause = {.tv_nsec = LOCK_PAUSE_NS};
  (void)memcpy(copy, path, strlen(path) + 1u);
  const int directory = open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    for (uint32_t tries = 0u; (tries < LOCK_TRIES) && (flock(directory, LOCK_EX | LOCK_NB) != 0); ++tries) {
      (void)nanosleep(&pause, NULL);
    }
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
    (void)ilk_fail(error, "'%s' exists and is not a socket; remove it or choose another path",
                   address->sun_path);
    return ILK_LISTEN_FAILED;
  }
  if (is_served(address)) {
    (void)ilk_fail(error, "socket '%s' is served by a running kernel; stop it or choose another path",
                   address->sun_path);
    return ILK_LISTEN_TAKEN;
  }
  if (unlink(address->sun_path) != 0) {
    (void)ilk_fail(error, "stale socket '%s' cannot be removed: %s", address->sun_path, strerror(errno));
    return ILK_LISTEN_FAILED;
  }
  return ILK_LISTEN_OK;
}

static bool bind_and_listen(ilk_link_socket_t *link, ilk_error_t *error) {
  const char *path = link->address.sun_path;
  struct stat status;
  link->descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (link->descriptor < 0) {
    return ilk_fail(error, "cannot create a socket: %s", strerror(errno));
  }
  const mode_t mask = umask(S_IXUSR | S_IRWXG | S_IRWXO);
  const int bound = bind(link->descriptor, (const struct sockaddr *)&link->address, sizeof link->address);
  const int reason = errno;
  (void)umask(mask);
  if (bound != 0) {
    (void)close(link->descriptor);
    return ilk_fail(error, "cannot bind socket '%s': %s", path, strerror(reason));
  }
  if (listen(link->descriptor, 8) != 0 || stat(path, &status) != 0) {
    const int cause = errno;
    (void)close(link->descriptor);
    (void)unlink(path);
    return ilk_fail(error, "cannot listen on socket '%s': %s", path, strerror(cause));
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
    (void)ilk_fail(error, "cannot open the directory of socket '%s': %s; create it first", path,
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
         ilk_fail(error, "socket '%s' cannot be shared with its group: %s", path, strerror(errno));
}

bool ilk_link_send(int client, const void *message, size_t bytes, const int descriptors[2]) {
  union {
    char bytes[CMSG_SPACE(2u * sizeof(int))];
    struct cmsghdr aligned;
  } control = {0};
  void *body = NULL;
  (void)memcpy(&body, &message, sizeof body); /* sendmsg only reads, but its structure does not say so */
  struct iovec part = {.iov_base = body, .iov_len = bytes};
  struct msghdr sent = {.msg_iov = &part,
                        .msg_iovlen = 1,
                        .msg_control = control.bytes,
                        .msg_controllen = sizeof control.bytes};
  struct cmsghdr *header = CMSG_FIRSTHDR(&sent);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(2u * sizeof(int));
  (void)memcpy(CMSG_DATA(header), descriptors, 2u * sizeof(int));
  return sendmsg(client, &sent, MSG_NOSIGNAL) == (ssize_t)bytes;
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
