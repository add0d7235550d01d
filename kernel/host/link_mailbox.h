/**
 * @file
 * How attachments pass between the link's server thread and the loop, without either waiting.
 *
 * The server offers an attachment; the loop takes it and, when done with it, puts it into `retired`,
 * from which the server collects it for unmapping.
 */
#ifndef INTERLOCK_HOST_LINK_MAILBOX_H
#define INTERLOCK_HOST_LINK_MAILBOX_H

#include <stdbool.h>
#include <stdint.h>

#include "link_region.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One app, from connecting to closing its socket. */
typedef struct {
  ilk_link_regions_t regions;
  uint32_t generation;
  uint32_t open; /**< 1 until the app's socket closes; atomic */
} ilk_attachment_t;

/** Hands apps over between the thread that accepts them and the loop. */
typedef struct {
  ilk_attachment_t *offered; /**< atomic */
  ilk_attachment_t *retired; /**< atomic */
} ilk_link_mailbox_t;

/** Whether the app behind it still holds its socket; false for NULL. */
bool ilk_attachment_is_open(const ilk_attachment_t *attachment);

/**
 * The loop's side, once a tick: the attachment to serve from now on, or NULL.
 *
 * A change waits for a later tick while the server has not yet collected what was retired before.
 */
ilk_attachment_t *ilk_mailbox_exchange(ilk_link_mailbox_t *mailbox, ilk_attachment_t *current);

#ifdef __cplusplus
}
#endif

#endif
