#include "link_mailbox.h"

#include <stddef.h>

bool ilk_attachment_is_open(const ilk_attachment_t *attachment) {
  return attachment != NULL && __atomic_load_n(&attachment->open, __ATOMIC_ACQUIRE) != 0u;
}

ilk_attachment_t *ilk_mailbox_exchange(ilk_link_mailbox_t *mailbox, ilk_attachment_t *current) {
  if (__atomic_load_n(&mailbox->retired, __ATOMIC_ACQUIRE) != NULL) {
    return current;
  }
  ilk_attachment_t *offered = __atomic_exchange_n(&mailbox->offered, NULL, __ATOMIC_ACQ_REL);
  if (offered == NULL && ilk_attachment_is_open(current)) {
    return current;
  }
  __atomic_store_n(&mailbox->retired, current, __ATOMIC_RELEASE);
  return offered;
}
