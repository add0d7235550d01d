#include <string.h>

#include "interlock/recording.h"
#include "parts.h"

#define ODD_FACTOR 0x9e3779b97f4a7c15u /* 2^64 divided by the golden ratio */

/** Mixing by an odd factor is one-to-one in either argument, so a difference cannot get lost on its way. */
static inline uint64_t mixed(uint64_t running, uint64_t next) { return (running ^ next) * ODD_FACTOR; }

static inline uint64_t pair_at(const unsigned char *bytes) {
  uint64_t pair = 0u;
  (void)memcpy(&pair, bytes, sizeof pair);
  return pair;
}

/* Four independent lanes, because each multiplication waits for the one before it in its lane; in variables
 * of their own, because an array of them would go through memory. */
static uint64_t digest_of(const void *words, size_t size) {
  const unsigned char *bytes = words;
  uint64_t first = 1u;
  uint64_t second = 2u;
  uint64_t third = 3u;
  uint64_t fourth = 4u;
  size_t place = 0u;
  for (; place + 32u <= size; place += 32u) {
    first = mixed(first, pair_at(&bytes[place]));
    second = mixed(second, pair_at(&bytes[place + 8u]));
    third = mixed(third, pair_at(&bytes[place + 16u]));
    fourth = mixed(fourth, pair_at(&bytes[place + 24u]));
  }
  uint64_t digest = mixed(mixed(mixed(mixed(0u, first), second), third), fourth);
  for (; place < size; place += sizeof(uint32_t)) {
    uint32_t word = 0u;
    (void)memcpy(&word, &bytes[place], sizeof word);
    digest = mixed(digest, word);
  }
  return digest ^ (digest >> 32);
}

uint64_t ilk_state_digest(const ilk_state_t *state) { return digest_of(state, sizeof *state); }

uint32_t ilk_out_digest(const ilk_outputs_t *out) { return (uint32_t)(digest_of(out, sizeof *out) >> 32); }

uint32_t ilk_alarm_of(const ilk_state_t *state) {
  uint32_t alarm = (state->system.mode & 0xfu) | ((state->system.cause & 0xfu) << 4);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; ++slot) {
    if (state->axis[slot].state == (uint32_t)ILK_AXIS_FAULTED) {
      alarm |= 0x100u << slot;
    }
  }
  return alarm;
}

uint32_t ilk_recording_crc(const uint32_t words[], uint32_t count) {
  uint32_t crc = ILK_CRC32_START;
  for (uint32_t i = 0u; i < count; ++i) {
    crc = ilk_crc32_word(crc, words[i]);
  }
  return crc ^ ILK_CRC32_START;
}
