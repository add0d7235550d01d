#include "black_box.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"

#define US_PER_S 1000000u
#define SPARE_BLOCKS 2u

uint32_t ilk_black_box_blocks(uint32_t period_us, uint32_t seconds) {
  const uint64_t ticks = (((uint64_t)seconds * US_PER_S) + period_us - 1u) / period_us;
  return (uint32_t)((ticks + ILK_BLOCK_TICKS_MIN - 1u) / ILK_BLOCK_TICKS_MIN) + SPARE_BLOCKS;
}

static void split(uint32_t words[2], uint64_t value) {
  words[0] = (uint32_t)value;
  words[1] = (uint32_t)(value >> 32);
}

static uint64_t utc_ms(void) {
  struct timespec now;
  (void)clock_gettime(CLOCK_REALTIME, &now);
  return ((uint64_t)now.tv_sec * 1000u) + ((uint64_t)now.tv_nsec / 1000000u);
}

static void describe(ilk_ring_header_t *ring, const ilk_black_box_terms_t *terms, uint32_t blocks) {
  ring->blocks = blocks;
  ring->run = (ilk_run_description_t){.version = ILK_RECORDING_VERSION,
                                      .layout_hash = ilk_recording_layout_hash(),
                                      .frame_words = (uint32_t)ILK_FRAME_WORDS,
                                      .clock = (uint32_t)terms->clock,
                                      .simulated = terms->simulated ? 1u : 0u,
                                      .config = *terms->config};
  split(ring->run.begun_utc_ms, utc_ms());
  split(ring->run.begun_monotonic_ns, ilk_now_ns());
}

/** Takes all memory now, so that no tick waits for any; 0 or the reason. */
static int map_ring(ilk_black_box_t *box) {
  const int taken = posix_fallocate(box->descriptor, 0, (off_t)box->bytes);
  if (taken != 0) {
    return taken;
  }
  if (flock(box->descriptor, LOCK_EX | LOCK_NB) != 0) {
    return errno;
  }
  void *address =
      mmap(NULL, box->bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, box->descriptor, 0);
  if (address == MAP_FAILED) {
    return errno;
  }
  box->ring = address;
  return 0;
}

bool ilk_black_box_create(ilk_black_box_t *box, const char *path, const ilk_black_box_terms_t *terms,
                          ilk_error_t *error) {
  const uint32_t blocks = ilk_black_box_blocks(terms->config->period_us, terms->seconds);
  *box = (ilk_black_box_t){.bytes = ILK_RING_HEADER_BYTES + ((size_t)blocks * ILK_BLOCK_BYTES)};
  (void)unlink(path);
  box->descriptor = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (box->descriptor < 0) {
    return ilk_fail(error, "black box '%s' cannot be made: %s", path, strerror(errno));
  }
  const int reason = map_ring(box);
  if (reason != 0) {
    (void)unlink(path);
    (void)close(box->descriptor);
    return ilk_fail(error,
                    "black box '%s' of %u s needs %zu MiB of shared memory: %s; make room, or record fewer "
                    "seconds",
                    path, terms->seconds, box->bytes >> 20, strerror(reason));
  }
  describe(box->ring, terms, blocks);
  __atomic_store_n(&box->ring->magic, ILK_RING_MAGIC, __ATOMIC_RELEASE);
  return true;
}

static uint32_t *payload_of(ilk_block_header_t *block) { return (uint32_t *)(void *)(block + 1); }

/** A reader that copies the old block at this place sees its number gone before any word of it changes. */
static void open_block(ilk_black_box_t *box) {
  ilk_ring_header_t *ring = box->ring;
  const uint32_t number = ring->head + 1u;
  unsigned char *blocks = (unsigned char *)ring + ILK_RING_HEADER_BYTES;
  box->block = (ilk_block_header_t *)(void *)&blocks[(size_t)(number % ring->blocks) * ILK_BLOCK_BYTES];
  __atomic_store_n(&box->block->number, 0u, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  (void)memcpy(payload_of(box->block), &box->tick[box->newest], ILK_OPENING_WORDS * sizeof(uint32_t));
  box->used = (uint32_t)ILK_OPENING_WORDS;
  box->block->magic = ILK_BLOCK_MAGIC;
  box->block->used = box->used;
  __atomic_store_n(&box->block->number, number, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->head, number, __ATOMIC_RELEASE);
}

void ilk_black_box_begin(ilk_black_box_t *box, const ilk_state_t *state) {
  box->tick[0].picture.state = *state;
  open_block(box);
}

#define GROUP 4u /* pairs that are looked at together */

static bool group_changed(const uint64_t now[GROUP], const uint64_t before[GROUP]) {
  return ((now[0] ^ before[0]) | (now[1] ^ before[1]) | (now[2] ^ before[2]) | (now[3] ^ before[3])) != 0u;
}

/** Copies the pairs that changed, and marks them; returns how many. Most groups did not change at all. */
static size_t put_changes(ilk_tick_record_t *head, const uint64_t now[ILK_PAIRS],
                          const uint64_t before[ILK_PAIRS], uint64_t *to) {
  size_t count = 0u;
  for (size_t word = 0u; word < ILK_CHANGED_WORDS; ++word) {
    uint32_t bits = 0u;
    for (size_t group = 0u; group < 32u; group += GROUP) {
      const size_t first = (word * 32u) + group;
      if (group_changed(&now[first], &before[first])) {
        for (size_t i = 0u; i < GROUP; ++i) {
          const uint32_t changed = (now[first + i] != before[first + i]) ? 1u : 0u;
          to[count] = now[first + i];
          count += changed;
          bits |= changed << (group + i);
        }
      }
    }
    head->changed[word] = bits;
  }
  return count;
}

/** Appends the requests to a record of so many words; returns its words then, made even. */
static uint32_t put_requests(uint32_t *record, uint32_t words, const ilk_request_t requests[],
                             uint32_t count) {
  (void)memcpy(&record[words], requests, count * sizeof(ilk_request_t));
  words += count * (uint32_t)(sizeof(ilk_request_t) / sizeof(uint32_t));
  if ((words & 1u) != 0u) {
    record[words] = 0u;
    words += 1u;
  }
  return words;
}

static void put_record(ilk_black_box_t *box, uint64_t begun_ns, const ilk_request_t requests[],
                       uint32_t count) {
  const ilk_picture_pairs_t *now = &box->tick[box->newest];
  const ilk_state_t *state = &now->picture.state;
  uint32_t *record = payload_of(box->block) + box->used;
  ilk_tick_record_t *head = (ilk_tick_record_t *)(void *)record;
  uint64_t *pairs = (uint64_t *)(void *)(head + 1);
  const size_t changed = put_changes(head, now->pair, box->tick[box->newest ^ 1u].pair, pairs);
  head->words = put_requests(record, (uint32_t)((sizeof *head + (changed * sizeof *pairs)) / sizeof *record),
                             requests, count);
  head->tick = state->tick;
  head->alarm = ilk_alarm_of(state);
  head->request_count = count;
  split(head->state_hash, ilk_state_hash(state));
  split(head->begun_ns, begun_ns);
  box->used += head->words;
  __atomic_store_n(&box->block->used, box->used, __ATOMIC_RELEASE);
}

/** The store behind the last changed pair is a pair beyond the longest record. */
static bool is_full(const ilk_black_box_t *box) {
  return box->used + ILK_RECORD_WORDS_MAX + 2u > ILK_PAYLOAD_WORDS_MAX;
}

void ilk_black_box_note(ilk_black_box_t *box, uint64_t begun_ns, const ilk_state_t *state,
                        const ilk_inputs_t *inputs, const ilk_request_t requests[], uint32_t count,
                        const ilk_outputs_t *out) {
  if (is_full(box)) {
    open_block(box);
  }
  box->newest ^= 1u;
  ilk_picture_t *picture = &box->tick[box->newest].picture;
  picture->state = *state;
  picture->inputs = *inputs;
  picture->out = *out;
  put_record(box, begun_ns, requests, count);
}

void ilk_black_box_close(ilk_black_box_t *box) {
  __atomic_store_n(&box->ring->closed, 1u, __ATOMIC_RELEASE);
  (void)munmap(box->ring, box->bytes);
  (void)close(box->descriptor);
}
