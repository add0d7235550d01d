/**
 * @file
 * Where the recorder and other readers get the black box: a socket, on which each connection is answered with
 * two descriptors and closed. The first is the memory, sealed against writing; the second is a pipe that
 * hangs up when the kernel ends, whatever way it ends.
 *
 * The socket is the kernel's user's alone, and no reader can make the kernel wait.
 */
#ifndef INTERLOCK_HOST_BLACK_BOX_DOOR_H
#define INTERLOCK_HOST_BLACK_BOX_DOOR_H

#include <pthread.h>

#include "black_box.h"
#include "link_socket.h"

#ifdef __cplusplus
extern "C" {
#endif

/** An open door. */
typedef struct {
  ilk_link_socket_t socket;
  int descriptors[2]; /**< handed out; borrowed */
  int stop;           /**< event that ends the thread */
  pthread_t thread;
} ilk_black_box_door_t;

/** Hands out the box on `path` from now on, in a thread of its own. The box outlives the door. */
ilk_listen_result_t ilk_black_box_door_open(ilk_black_box_door_t *door, const char *path,
                                            const ilk_black_box_t *box, ilk_error_t *error);

/** Ends the thread and removes the socket; readers keep what they hold. */
void ilk_black_box_door_close(ilk_black_box_door_t *door);

#ifdef __cplusplus
}
#endif

#endif
