/**
 * @file
 * The kernel's end of the request ring. Every byte of the ring is hostile.
 */
#ifndef INTERLOCK_HOST_RING_READER_H
#define INTERLOCK_HOST_RING_READER_H

#include <stdint.h>

#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Copies waiting requests, each word once, at most ILK_REQUESTS_PER_TICK of them.
 *
 * A head farther ahead than the ring is long cannot be honest: all that it claims is skipped and counted.
 *
 * @param tail requests consumed, the kernel's own copy; advanced.
 * @param dropped increased, saturating, by the requests that were skipped.
 * @return requests copied.
 */
uint32_t ilk_ring_read(const ilk_link_app_region_t *app, uint32_t *tail, uint32_t *dropped,
                       ilk_request_t requests[ILK_REQUESTS_PER_TICK]);

#ifdef __cplusplus
}
#endif

#endif
