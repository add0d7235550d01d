#include "histogram.h"

static uint32_t bucket_of(uint32_t nanoseconds) {
  return nanoseconds < 2u ? 0u : 31u - (uint32_t)__builtin_clz(nanoseconds);
}

void ilk_timing_add(ilk_timing_t *timing, ilk_phase_t phase, uint64_t nanoseconds) {
  const uint32_t shown = nanoseconds > UINT32_MAX ? UINT32_MAX : (uint32_t)nanoseconds;
  uint32_t *count = &timing->bucket[phase][bucket_of(shown)];
  if (*count < UINT32_MAX) {
    *count += 1u;
  }
  if (timing->max_ns[phase] < shown) {
    timing->max_ns[phase] = shown;
  }
}
