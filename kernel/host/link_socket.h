/**
 * @file
 * A listening socket of the kernel, and the rule that there is one kernel per path.
 */
#ifndef INTERLOCK_HOST_LINK_SOCKET_H
#define INTERLOCK_HOST_LINK_SOCKET_H

#include <stddef.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Whether the socket could be taken. */
typedef enum {
  ILK_LISTEN_OK,
  ILK_LISTEN_TAKEN, /**< a living process holds the path; it was not disturbed */
  ILK_LISTEN_FAILED
} ilk_listen_result_t;

/** A listening socket that is ours. */
typedef struct {
  int descriptor;
  struct sockaddr_un address;
  dev_t device; /**< of the socket file, so that only our own is removed */
  ino_t inode;
} ilk_link_socket_t;

/** Fills in the address of a Unix socket, or says why the path cannot be one. */
bool ilk_unix_address(const char *path, struct sockaddr_un *address, ilk_error_t *error);

/**
 * Listens on `path`, readable and writable by the owner alone. Replaces a socket that nobody holds any
 * more, and nothing else.
 */
ilk_listen_result_t ilk_link_listen(ilk_link_socket_t *link, const char *path, ilk_error_t *error);

/** Lets the members of this process' group connect, too; at first only its user may. */
bool ilk_link_share(const ilk_link_socket_t *link, ilk_error_t *error);

/** Sends a message with two descriptors; false when the other side does not take it at once. */
bool ilk_link_send(int client, const void *message, size_t bytes, const int descriptors[2]);

/** Stops listening and removes the socket's file. */
void ilk_link_unlisten(ilk_link_socket_t *link);

#ifdef __cplusplus
}
#endif

#endif
