#include <string.h>

#include "crc32.h"
#include "interlock/recording.h"

#define LANES 4u
#define ODD_FACTOR 0x9e3779b97f4a7c15u /* 2^64 divided by the golden ratio */

/** Mixing by an odd factor is one-to-one in either argument, so a difference cannot get lost on its way. */
static uint64_t mixed(uint64_t running, uint64_t next) { return (running ^ next) * ODD_FACTOR; }

/* Four independent lanes, because each multiplication waits for the one before it in its lane. */
uint64_t ilk_state_hash(const ilk_state_t *state) {
  const unsigned char *bytes = (const unsigned char *)state;
  uint64_t lane[LANES] = {1u, 2u, 3u, 4u};
  uint64_t next[LANES];
  size_t place = 0u;
  for (; place + sizeof next <= sizeof *state; place += sizeof next) {
    (void)memcpy(next, &bytes[place], sizeof next);
    for (size_t i = 0u; i < LANES; ++i) {
      lane[i] = mixed(lane[i], next[i]);
    }
  }
  uint64_t hash = 0u;
  for (size_t i = 0u; i < LANES; ++i) {
    hash = mixed(hash, lane[i]);
  }
  for (; place < sizeof *state; place += sizeof(uint32_t)) {
    uint32_t word = 0u;
    (void)memcpy(&word, &bytes[place], sizeof word);
    hash = mixed(hash, word);
  }
  return hash ^ (hash >> 32);
}

uint32_t ilk_alarm_of(const ilk_state_t *state) {
  uint32_t alarm = (state->mode & 0xfu) | ((state->cause & 0xfu) << 4);
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
  return ilk_crc32_finish(crc);
}
