#include "link_server.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "link_socket.h"
#include "service_thread.h"

#define COLLECT_INTERVAL_MS 20

static void destroy_attachment(ilk_link_server_t *server, ilk_attachment_t *attachment) {
  if (attachment != NULL) {
    ilk_link_regions_destroy(&attachment->regions);
    free(attachment);
    server->alive -= 1u;
  }
}

static void collect_retired(ilk_link_server_t *server) {
  destroy_attachment(server, __atomic_exchange_n(&server->mailbox.retired, NULL, __ATOMIC_ACQ_REL));
}

static void offer(ilk_link_server_t *server, ilk_attachment_t *attachment) {
  destroy_attachment(server, __atomic_exchange_n(&server->mailbox.offered, attachment, __ATOMIC_ACQ_REL));
}

static ilk_attachment_t *create_attachment(ilk_link_server_t *server) {
  ilk_error_t error;
  ilk_attachment_t *attachment = calloc(1, sizeof *attachment);
  if (attachment == NULL) {
    return NULL;
  }
  server->generation += 1u;
  if (!ilk_link_regions_create(&attachment->regions, server->generation, &error)) {
    (void)fprintf(stderr, "link: %s; the app was turned away\n", error.text);
    free(attachment);
    return NULL;
  }
  attachment->generation = server->generation;
  attachment->open = 1u;
  server->alive += 1u;
  return attachment;
}

static bool send_hello(int client, const ilk_attachment_t *attachment) {
  ilk_link_hello_t hello = {.magic = ILK_LINK_MAGIC,
                            .version = ILK_LINK_VERSION,
                            .layout_hash = ilk_link_layout_hash(),
                            .generation = attachment->generation,
                            .kernel_region_bytes = (uint32_t)sizeof(ilk_link_kernel_region_t),
                            .app_region_bytes = (uint32_t)sizeof(ilk_link_app_region_t)};
  const int descriptors[2] = {attachment->regions.kernel_descriptor, attachment->regions.app_descriptor};
  return ilk_link_send(client, &hello, sizeof hello, descriptors);
}

static void attach(ilk_link_server_t *server, int client) {
  ilk_attachment_t *attachment = create_attachment(server);
  if (attachment == NULL) {
    (void)close(client);
    return;
  }
  if (!send_hello(client, attachment)) {
    destroy_attachment(server, attachment);
    (void)close(client);
    return;
  }
  server->client = client;
  server->attached = attachment;
}

static bool is_settled(const ilk_attachment_t *attachment) { return attachment->regions.app != NULL; }

/** The loop holds what was offered to it; what was not is destroyed here. */
static void detach(ilk_link_server_t *server) {
  (void)close(server->client);
  server->client = -1;
  if (is_settled(server->attached)) {
    __atomic_store_n(&server->attached->open, 0u, __ATOMIC_RELEASE);
  } else {
    destroy_attachment(server, server->attached);
  }
  server->attached = NULL;
}

static bool says_mapped(int client) {
  uint32_t word = 0;
  return recv(client, &word, sizeof word, MSG_DONTWAIT) == (ssize_t)sizeof word && word == ILK_LINK_MAGIC;
}

/** The app says once that it mapped its region; all else is the end of the attachment or a breach of the
 * contract. */
static void hear_client(ilk_link_server_t *server) {
  ilk_attachment_t *attachment = server->attached;
  if (!is_settled(attachment) && says_mapped(server->client) &&
      ilk_link_regions_settle(&attachment->regions)) {
    offer(server, attachment);
  } else {
    detach(server);
  }
}

static bool client_was_heard(const ilk_link_server_t *server) {
  struct pollfd wanted = {.fd = server->client, .events = POLLIN | POLLRDHUP};
  return server->client >= 0 && poll(&wanted, 1, 0) != 0;
}

static void accept_app(ilk_link_server_t *server) {
  const int client = accept4(server->listener, NULL, NULL, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client < 0) {
    return;
  }
  while (client_was_heard(server)) {
    hear_client(server);
  }
  if (server->client >= 0) {
    (void)close(client);
    return;
  }
  attach(server, client);
}

static bool uncollected(const ilk_link_server_t *server) {
  return server->alive > (server->attached != NULL ? 1u : 0u);
}

static void *serve(void *argument) {
  ilk_link_server_t *server = argument;
  for (;;) {
    struct pollfd events[3] = {{.fd = server->stop, .events = POLLIN},
                               {.fd = server->client, .events = POLLIN | POLLRDHUP},
                               {.fd = server->listener, .events = POLLIN}};
    (void)poll(events, 3, uncollected(server) ? COLLECT_INTERVAL_MS : -1);
    if (events[0].revents != 0) {
      return NULL;
    }
    if (events[1].revents != 0) {
      hear_client(server);
    }
    collect_retired(server);
    if (events[2].revents != 0) {
      accept_app(server);
    }
  }
}

bool ilk_link_server_start(ilk_link_server_t *server, int listener, ilk_error_t *error) {
  *server = (ilk_link_server_t){.listener = listener, .client = -1};
  server->stop = eventfd(0, EFD_CLOEXEC);
  if (server->stop < 0) {
    return ilk_fail(error, "cannot create the link server's stop event: %s", strerror(errno));
  }
  if (!ilk_service_thread_start(&server->thread, serve, server, error)) {
    (void)close(server->stop);
    return false;
  }
  return true;
}

void ilk_link_server_stop(ilk_link_server_t *server, ilk_attachment_t *current) {
  ilk_service_thread_stop(server->thread, server->stop);
  if (server->client >= 0) {
    detach(server);
  }
  offer(server, NULL);
  collect_retired(server);
  destroy_attachment(server, current);
}
