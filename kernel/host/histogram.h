/**
 * @file
 * How long the phases of a tick take, by powers of two.
 */
#ifndef INTERLOCK_HOST_HISTOGRAM_H
#define INTERLOCK_HOST_HISTOGRAM_H

#include <stdint.h>

#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Counts one duration. Below 2 ns: bucket 0. Counts and maxima saturate. */
void ilk_timing_add(ilk_timing_t *timing, ilk_phase_t phase, uint64_t nanoseconds);

#ifdef __cplusplus
}
#endif

#endif
