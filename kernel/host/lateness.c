#include "lateness.h"

#define NS_PER_US 1000u
#define NS_PER_MS 1000000u
#define NS_PER_S 1000000000u

static uint32_t saturated(uint64_t number) { return number > UINT32_MAX ? UINT32_MAX : (uint32_t)number; }

void ilk_lateness_add(ilk_lateness_watch_t *watch, ilk_lateness_t *shown, uint64_t waited_ns,
                      uint64_t now_ns) {
  const uint32_t waited_us = saturated(waited_ns / NS_PER_US);
  watch->total_ns += waited_ns;
  watch->second_ns += waited_ns;
  if (watch->second_began_ns == 0u) {
    watch->second_began_ns = now_ns;
  }
  if (now_ns - watch->second_began_ns >= NS_PER_S) {
    shown->second_us = saturated(watch->second_ns / NS_PER_US);
    watch->second_ns = 0u;
    watch->second_began_ns = now_ns;
  }
  shown->total_ms = saturated(watch->total_ns / NS_PER_MS);
  if (shown->worst_us < waited_us) {
    shown->worst_us = waited_us;
  }
}
