/**
 * @file
 * The two memory regions of one attachment.
 */
#ifndef INTERLOCK_HOST_LINK_REGION_H
#define INTERLOCK_HOST_LINK_REGION_H

#include <stdbool.h>
#include <stdint.h>

#include "error.h"
#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  ilk_link_kernel_region_t *kernel; /**< the only writable mapping that can ever exist of it */
  const ilk_link_app_region_t *app; /**< mapped for reading only; NULL until the app has mapped it */
  int kernel_descriptor;            /**< to be handed over; -1 once closed */
  int app_descriptor;               /**< to be handed over; -1 once closed */
} ilk_link_regions_t;

/**
 * Creates both regions, and maps the kernel's.
 *
 * The kernel's region is sealed against future writable mappings after it was mapped: whoever receives the
 * descriptor cannot write to it, by mapping, `mprotect`, `write` or reopening. Neither region can change its
 * size.
 */
bool ilk_link_regions_create(ilk_link_regions_t *regions, uint32_t generation, ilk_error_t *error);

/**
 * Once the app has mapped its region: seals it against every other way to write to it or to take pages out of
 * it, and maps it with all its pages there, so that no access of the loop can ever meet a missing one. Closes
 * the descriptors. False when the app sealed it before, or memory is short.
 */
bool ilk_link_regions_settle(ilk_link_regions_t *regions);

/** Closes the descriptors; the mappings stay. */
void ilk_link_regions_close(ilk_link_regions_t *regions);

/** Closes and unmaps. */
void ilk_link_regions_destroy(ilk_link_regions_t *regions);

#ifdef __cplusplus
}
#endif

#endif
