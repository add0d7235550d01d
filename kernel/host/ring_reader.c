#include "ring_reader.h"

#include "atomic_words.h"

_Static_assert((ILK_LINK_REQUESTS & (ILK_LINK_REQUESTS - 1u)) == 0u,
               "the ring's index wraps with its counter");

static uint32_t saturating_add(uint32_t a, uint32_t b) { return a > UINT32_MAX - b ? UINT32_MAX : a + b; }

uint32_t ilk_ring_read(const ilk_link_app_region_t *app, uint32_t *tail, uint32_t *dropped,
                       ilk_request_t requests[ILK_REQUESTS_PER_TICK]) {
  const uint32_t head = __atomic_load_n(&app->request_head, __ATOMIC_ACQUIRE);
  const uint32_t waiting = head - *tail;
  if (waiting > ILK_LINK_REQUESTS) {
    *dropped = saturating_add(*dropped, waiting);
    *tail = head;
    return 0u;
  }
  const uint32_t count =
      waiting < (uint32_t)ILK_REQUESTS_PER_TICK ? waiting : (uint32_t)ILK_REQUESTS_PER_TICK;
  for (uint32_t i = 0; i < count; ++i) {
    ilk_words_load((uint32_t *)&requests[i], (const uint32_t *)&app->request[(*tail + i) % ILK_LINK_REQUESTS],
                   sizeof(ilk_request_t) / sizeof(uint32_t));
  }
  *tail += count;
  return count;
}
