#include "black_box_door.h"

#include <errno.h>
#include <poll.h>
#include <stddef.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "service_thread.h"

static void *serve_readers(void *argument) {
  const ilk_black_box_door_t *door = argument;
  const uint32_t magic = ILK_RING_MAGIC;
  struct pollfd events[2] = {{.fd = door->stop, .events = POLLIN},
                             {.fd = door->socket.descriptor, .events = POLLIN}};
  for (;;) {
    (void)poll(events, 2, -1);
    if (events[0].revents != 0) {
      return NULL;
    }
    const int reader = accept4(door->socket.descriptor, NULL, NULL, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (reader >= 0) {
      (void)ilk_link_send(reader, &magic, sizeof magic, door->descriptors);
      (void)close(reader);
    }
  }
}

static bool start_serving(ilk_black_box_door_t *door, ilk_error_t *error) {
  door->stop = eventfd(0, EFD_CLOEXEC);
  if (door->stop < 0) {
    return ilk_fail(error, "cannot create the stop event of the black box's door: %s", strerror(errno));
  }
  if (!ilk_service_thread_start(&door->thread, serve_readers, door, error)) {
    (void)close(door->stop);
    return false;
  }
  return true;
}

ilk_listen_result_t ilk_black_box_door_open(ilk_black_box_door_t *door, const char *path,
                                            const ilk_black_box_t *box, ilk_error_t *error) {
  *door = (ilk_black_box_door_t){.descriptors = {box->memory, box->life[0]}};
  ilk_listen_result_t result = ilk_link_listen(&door->socket, path, error);
  if (result == ILK_LISTEN_OK && !start_serving(door, error)) {
    ilk_link_unlisten(&door->socket);
    result = ILK_LISTEN_FAILED;
  }
  return result;
}

void ilk_black_box_door_close(ilk_black_box_door_t *door) {
  ilk_service_thread_stop(door->thread, door->stop);
  ilk_link_unlisten(&door->socket);
}
