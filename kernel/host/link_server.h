/**
 * @file
 * The thread that attaches apps: not real-time, so that the loop never waits for one.
 */
#ifndef INTERLOCK_HOST_LINK_SERVER_H
#define INTERLOCK_HOST_LINK_SERVER_H

#include <pthread.h>
#include <stdint.h>

#include "error.h"
#include "link_mailbox.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int listener;               /**< borrowed listening socket */
  int stop;                   /**< event descriptor */
  int client;                 /**< socket of the attached app, or -1 */
  uint32_t generation;        /**< of the newest attachment */
  uint32_t alive;             /**< attachments that are not yet destroyed */
  ilk_attachment_t *attached; /**< to be marked closed when the client goes; owned through the mailbox */
  ilk_link_mailbox_t mailbox;
  pthread_t thread;
} ilk_link_server_t;

/** Starts the thread, with all signals blocked, on a listening socket that outlives it. */
bool ilk_link_server_start(ilk_link_server_t *server, int listener, ilk_error_t *error);

/**
 * Ends the thread, closes the app's socket and destroys every attachment. The loop must have ended.
 *
 * @param current the attachment that the loop still holds, or NULL.
 */
void ilk_link_server_stop(ilk_link_server_t *server, ilk_attachment_t *current);

#ifdef __cplusplus
}
#endif

#endif
