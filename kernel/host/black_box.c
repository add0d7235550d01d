#include "black_box.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "clock.h"

#define US_PER_S 1000000u
#define SPARE_BLOCKS 2u
#define GROUP_WORDS 32u
#define QUARTER_WORDS 4u
#define WHOLE_GROUPS (ILK_GIVEN_GROUPS * GROUP_WORDS)
#define SEALS (F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL)

/** Whole blocks for so many seconds, the one being written, the one being reused. */
static uint32_t blocks_for(uint32_t period_us, uint32_t seconds) {
  const uint64_t period = period_us;
  const uint64_t ticks = (((uint64_t)seconds * US_PER_S) + period - 1u) / period;
  const uint64_t bytes = ticks * ILK_BLACK_BOX_BYTES_A_TICK;
  return (uint32_t)((bytes + ILK_BLOCK_BYTES - 1u) / ILK_BLOCK_BYTES) + SPARE_BLOCKS;
}

static void split(uint32_t words[2], uint64_t value) {
  words[0] = (uint32_t)value;
  words[1] = (uint32_t)(value >> 32);
}

static void describe(ilk_ring_header_t *ring, const ilk_black_box_terms_t *terms, uint32_t blocks) {
  ring->blocks = blocks;
  ring->seconds = terms->seconds;
  ring->run = (ilk_run_description_t){.version = ILK_RECORDING_VERSION,
                                      .layout_hash = ilk_recording_layout_hash(),
                                      .frame_words = (uint32_t)ILK_FRAME_WORDS,
                                      .clock = (uint32_t)terms->clock,
                                      .simulated = terms->simulated ? 1u : 0u,
                                      .config = *terms->config};
  split(ring->run.begun_utc_ms, ilk_utc_ms());
  split(ring->run.begun_monotonic_ns, ilk_now_ns());
  __atomic_store_n(&ring->magic, ILK_RING_MAGIC, __ATOMIC_RELEASE);
}

static void *map_part(int descriptor, size_t offset, size_t bytes) {
  return mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor, (off_t)offset);
}

/** 0 or the reason. After the mapping nobody can write, shrink or punch holes any more. */
static int take_memory(ilk_black_box_t *box) {
  box->memory = memfd_create("interlock-black-box", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (box->memory < 0) {
    return errno;
  }
  const int taken = posix_fallocate(box->memory, 0, (off_t)box->bytes);
  if (taken != 0) {
    return taken;
  }
  void *header = map_part(box->memory, 0u, ILK_RING_HEADER_BYTES);
  void *blocks = map_part(box->memory, ILK_RING_HEADER_BYTES, box->bytes - ILK_RING_HEADER_BYTES);
  if (header == MAP_FAILED || blocks == MAP_FAILED || fcntl(box->memory, F_ADD_SEALS, SEALS) != 0 ||
      pipe2(box->life, O_CLOEXEC) != 0) {
    return errno;
  }
  box->ring = header;
  box->blocks = blocks;
  return 0;
}

bool ilk_black_box_create(ilk_black_box_t *box, const ilk_black_box_terms_t *terms, ilk_error_t *error) {
  const uint32_t blocks = blocks_for(terms->config->common.period_us, terms->seconds);
  *box = (ilk_black_box_t){.bytes = ILK_RING_HEADER_BYTES + ((size_t)blocks * ILK_BLOCK_BYTES)};
  const int reason = take_memory(box);
  if (reason != 0) {
    return ilk_fail(error,
                    "black box of %u s needs %zu MiB of memory: %s; make room, or record fewer seconds",
                    terms->seconds, box->bytes >> 20, strerror(reason));
  }
  describe(box->ring, terms, blocks);
  return true;
}

static uint32_t opening_tick(const ilk_block_t *block) {
  return block->payload[(size_t)offsetof(ilk_state_t, system.tick) / sizeof(uint32_t)];
}

/** When a block is about to be reused: how many ticks there are without it, and without the one that comes
 * next, which readers no longer begin with. */
static void count_held(const ilk_black_box_t *box, uint32_t next, uint32_t tick) {
  ilk_ring_header_t *ring = box->ring;
  if (next > ring->blocks) {
    const uint32_t held = tick - opening_tick(&box->blocks[(next + 2u) % ring->blocks]);
    if ((ring->fewest_ticks == 0u) || (held < ring->fewest_ticks)) {
      __atomic_store_n(&ring->fewest_ticks, held, __ATOMIC_RELAXED);
    }
  }
}

/** A reader that copies the old block at this place sees its number gone before any word of it changes. */
static void open_block(ilk_black_box_t *box, const ilk_state_t *state) {
  ilk_ring_header_t *ring = box->ring;
  const uint32_t number = ring->head + 1u;
  count_held(box, number, state->system.tick);
  box->block = &box->blocks[number % ring->blocks];
  ilk_block_header_t *header = &box->block->header;
  __atomic_store_n(&header->number, 0u, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  (void)memcpy(box->block->payload, state, sizeof *state);
  box->used = (uint32_t)ILK_OPENING_WORDS;
  (void)memset(&box->expected, 0, sizeof box->expected);
  header->magic = ILK_BLOCK_MAGIC;
  header->used = box->used;
  __atomic_store_n(&header->number, number, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->head, number, __ATOMIC_RELEASE);
}

void ilk_black_box_begin(ilk_black_box_t *box, const ilk_state_t *state) { open_block(box, state); }

/** Copies the words of a group that were not expected; returns which. Most quarters were expected as a whole.
 */
static uint32_t put_group(uint32_t to[], uint32_t *place, const uint32_t given[], const uint32_t missed[]) {
  uint32_t bits = 0u;
  for (uint32_t first = 0u; first < GROUP_WORDS; first += QUARTER_WORDS) {
    if ((missed[first] | missed[first + 1u] | missed[first + 2u] | missed[first + 3u]) != 0u) {
      for (uint32_t i = first; i < (first + QUARTER_WORDS); ++i) {
        uint32_t is_missed = 0u;
        if (missed[i] != 0u) {
          is_missed = 1u;
        }
        to[*place] = given[i];
        *place += is_missed;
        bits |= is_missed << i;
      }
    }
  }
  return bits;
}

/** Writes what was given, so many words, behind the head of the record; returns the record's length. */
static uint32_t put_given(uint32_t record[], ilk_tick_record_t *head, const uint32_t given[],
                          const uint32_t missed[], uint32_t count) {
  uint32_t bits[ILK_GIVEN_GROUPS];
  uint32_t word[WHOLE_GROUPS];
  uint32_t words = 0u;
  uint32_t groups = 0u;
  for (uint32_t first = 0u; first < count; first += GROUP_WORDS) {
    bits[groups] = put_group(word, &words, &given[first], &missed[first]);
    if (bits[groups] != 0u) {
      head->groups |= (uint32_t)1u << (first / GROUP_WORDS);
      groups += 1u;
    }
  }
  (void)memcpy(&record[ILK_RECORD_HEAD_WORDS], bits, groups * sizeof bits[0]);
  (void)memcpy(&record[ILK_RECORD_HEAD_WORDS + groups], word, words * sizeof word[0]);
  return (uint32_t)ILK_RECORD_HEAD_WORDS + groups + words;
}

void ilk_black_box_note(ilk_black_box_t *box, uint64_t begun_ns, const ilk_state_t *state,
                        const ilk_inputs_t *inputs, const ilk_request_t requests[], uint32_t count,
                        const ilk_outputs_t *out) {
  uint32_t given[WHOLE_GROUPS];
  uint32_t missed[WHOLE_GROUPS];
  const uint32_t words = ilk_given_words(count);
  ilk_tick_record_t head = {.tick = state->system.tick,
                            .alarm = ilk_alarm_of(state),
                            .request_count = count,
                            .out_digest = ilk_out_digest(out)};
  ilk_given_from_inputs(given, inputs);
  (void)memcpy(&given[ILK_INPUT_WORDS], requests, count * sizeof(ilk_request_t));
  ilk_expectation_follow(&box->expected, given, words, missed);
  const uint32_t rest = (GROUP_WORDS - 1u) & (0u - words); /* of its last group */
  (void)memset(&given[words], 0, rest * sizeof given[0]);
  (void)memset(&missed[words], 0, rest * sizeof missed[0]);
  split(head.state_digest, ilk_state_digest(state));
  split(head.begun_ns, begun_ns);
  uint32_t *record = &box->block->payload[box->used];
  head.words = put_given(record, &head, given, missed, words);
  (void)memcpy(record, &head, sizeof head);
  box->used += head.words;
  __atomic_store_n(&box->block->header.used, box->used, __ATOMIC_RELEASE);
  if ((box->used + ILK_RECORD_WORDS_MAX) > ILK_PAYLOAD_WORDS_MAX) {
    open_block(box, state);
  }
}

void ilk_black_box_close(ilk_black_box_t *box) {
  __atomic_store_n(&box->ring->closed, 1u, __ATOMIC_RELEASE);
  (void)munmap(box->blocks, box->bytes - ILK_RING_HEADER_BYTES);
  (void)munmap(box->ring, ILK_RING_HEADER_BYTES);
  (void)close(box->memory);
  (void)close(box->life[0]);
  (void)close(box->life[1]);
}
