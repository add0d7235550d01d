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
  const ilk_link_app_region_t *app; /**< mapped for reading only */
  int kernel_descriptor;            /**< to be handed over; -1 once closed */
  int app_descriptor;               /**< to be handed over; -1 once closed */
} ilk_link_regions_t;

/**
 * Creates, maps and seals both regions.
 *
 * The kernel's region is sealed against future writable mappings after it was mapped: whoever receives the
 * descriptor cannot write to it, by mapping, `mprotect`, `write` or reopening. Neither region can change its
 * size, so that no access of the kernel can meet a missing page.
 */
bool ilk_link_regions_create(ilk_link_regions_t *regions, uint32_t generation, ilk_error_t *error);

/** Closes the descriptors; the mappings stay. */
void ilk_link_regions_close(ilk_link_regions_t *regions);

/** Closes and unmaps. */
void ilk_link_regions_destroy(ilk_link_regions_t *regions);

#ifdef __cplusplus
}
#endif

#endif
