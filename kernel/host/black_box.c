#include "black_box.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include "clock.h"

#define US_PER_S 1000000u
#define NAME_BYTES 4096u
#define SPARE_BLOCKS 2u
#define WORDS_A_PAIR (sizeof(uint64_t) / sizeof(uint32_t))
#define HEAD_PAIRS (sizeof(ilk_tick_record_t) / sizeof(uint64_t))

/** Blocks that hold so many seconds whatever changes: whole ones, the one being written, the one being
 * reused. */
static uint32_t blocks_for(uint32_t period_us, uint32_t seconds) {
  const uint64_t period = period_us;
  const uint64_t ticks = (((uint64_t)seconds * US_PER_S) + period - 1u) / period;
  const uint64_t ticks_a_block = (uint64_t)ILK_BLOCK_TICKS_MIN;
  return (uint32_t)((ticks + ticks_a_block - 1u) / ticks_a_block) + SPARE_BLOCKS;
}

static void split(uint32_t words[2], uint64_t value) {
  words[0] = (uint32_t)value;
  words[1] = (uint32_t)(value >> 32);
}

static void describe(ilk_ring_header_t *ring, const ilk_black_box_terms_t *terms, uint32_t blocks) {
  ring->blocks = blocks;
  ring->run = (ilk_run_description_t){.version = ILK_RECORDING_VERSION,
                                      .layout_hash = ilk_recording_layout_hash(),
                                      .frame_words = (uint32_t)ILK_FRAME_WORDS,
                                      .clock = (uint32_t)terms->clock,
                                      .simulated = terms->simulated ? 1u : 0u,
                                      .config = *terms->config};
  split(ring->run.begun_utc_ms, ilk_utc_ms());
  split(ring->run.begun_monotonic_ns, ilk_now_ns());
}

static void *map_part(int descriptor, size_t offset, size_t bytes) {
  return mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor, (off_t)offset);
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
  void *header = map_part(box->descriptor, 0u, ILK_RING_HEADER_BYTES);
  void *blocks = map_part(box->descriptor, ILK_RING_HEADER_BYTES, box->bytes - ILK_RING_HEADER_BYTES);
  if (header == MAP_FAILED || blocks == MAP_FAILED) {
    return errno;
  }
  box->ring = header;
  box->blocks = blocks;
  return 0;
}

static bool name_beside(char name[NAME_BYTES], const char *path, const char *ending) {
  const size_t length = strlen(path);
  const size_t more = strlen(ending) + 1u;
  const bool fits = (length + more) <= NAME_BYTES;
  if (fits) {
    (void)memcpy(name, path, length);
    (void)memcpy(&name[length], ending, more);
  }
  return fits;
}

static bool is_of_a_living_kernel(const char *path) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  const bool held = (descriptor >= 0) && (flock(descriptor, LOCK_SH | LOCK_NB) != 0);
  if (descriptor >= 0) {
    (void)close(descriptor);
  }
  return held;
}

/** What the kernel before left keeps a name until a recorder has it on the disk; one can wait. */
static bool keeps_what_was_left(const char *path, const char *before) {
  return (link(path, before) == 0) || (errno == ENOENT) || (errno == EEXIST);
}

bool ilk_black_box_create(ilk_black_box_t *box, const char *path, const ilk_black_box_terms_t *terms,
                          ilk_error_t *error) {
  char making[NAME_BYTES];
  char before[NAME_BYTES];
  const uint32_t blocks = blocks_for(terms->config->period_us, terms->seconds);
  *box = (ilk_black_box_t){.bytes = ILK_RING_HEADER_BYTES + ((size_t)blocks * ILK_BLOCK_BYTES)};
  if (!name_beside(making, path, ILK_RING_MAKING) || !name_beside(before, path, ILK_RING_BEFORE)) {
    return ilk_fail(error, "black box '%s': the name is too long", path);
  }
  if (is_of_a_living_kernel(path)) {
    return ilk_fail(error, "black box '%s' is that of a kernel that runs; stop it, or choose another file",
                    path);
  }
  (void)unlink(making);
  box->descriptor = open(making, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (box->descriptor < 0) {
    return ilk_fail(error, "black box '%s' cannot be made: %s", path, strerror(errno));
  }
  const int reason = map_ring(box);
  if (reason != 0) {
    (void)unlink(making);
    (void)close(box->descriptor);
    return ilk_fail(
        error,
        "black box '%s' of %u s needs %zu MiB of shared memory, beside '%s' if that is there: %s; "
        "make room, or record fewer seconds",
        path, terms->seconds, box->bytes >> 20, before, strerror(reason));
  }
  describe(box->ring, terms, blocks);
  __atomic_store_n(&box->ring->magic, ILK_RING_MAGIC, __ATOMIC_RELEASE);
  if (!keeps_what_was_left(path, before) || (rename(making, path) != 0)) {
    const int refused = errno;
    (void)unlink(making);
    (void)close(box->descriptor);
    return ilk_fail(error, "black box '%s' cannot be made: %s", path, strerror(refused));
  }
  return true;
}

static uint32_t words_of(size_t pairs) { return (uint32_t)(pairs * WORDS_A_PAIR); }

/** A reader that copies the old block at this place sees its number gone before any word of it changes. */
static void open_block(ilk_black_box_t *box) {
  ilk_ring_header_t *ring = box->ring;
  const uint32_t number = ring->head + 1u;
  box->block = &box->blocks[number % ring->blocks];
  ilk_block_header_t *header = &box->block->header;
  __atomic_store_n(&header->number, 0u, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  (void)memcpy(box->block->payload, box->tick[box->newest].pair, sizeof box->tick[0].pair);
  box->used = ILK_PAIRS;
  header->magic = ILK_BLOCK_MAGIC;
  header->used = words_of(box->used);
  __atomic_store_n(&header->number, number, __ATOMIC_RELEASE);
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
                          const uint64_t before[ILK_PAIRS], uint64_t to[]) {
  size_t count = 0u;
  for (size_t word = 0u; word < ILK_CHANGED_WORDS; ++word) {
    uint32_t bits = 0u;
    for (uint32_t group = 0u; group < 32u; group += GROUP) {
      const size_t first = (word * 32u) + group;
      if (group_changed(&now[first], &before[first])) {
        for (uint32_t i = 0u; i < GROUP; ++i) {
          const uint64_t pair = now[first + i];
          uint32_t changed = 0u;
          if (pair != before[first + i]) {
            changed = 1u;
          }
          const uint32_t place = group + i;
          to[count] = pair;
          count += changed;
          bits |= changed << place;
        }
      }
    }
    head->changed[word] = bits;
  }
  return count;
}

/** Copies the requests, the last pair filled up with zero; returns how many pairs they take. */
static size_t put_requests(uint64_t to[], const ilk_request_t requests[], uint32_t count) {
  const size_t bytes = count * sizeof(ilk_request_t);
  const size_t pairs = (bytes + sizeof(uint64_t) - 1u) / sizeof(uint64_t);
  if (pairs > 0u) {
    to[pairs - 1u] = 0u;
  }
  (void)memcpy(to, requests, bytes);
  return pairs;
}

static void put_record(ilk_black_box_t *box, uint64_t begun_ns, const ilk_request_t requests[],
                       uint32_t count) {
  const ilk_picture_pairs_t *now = &box->tick[box->newest];
  const ilk_state_t *state = &now->picture.state;
  uint64_t *record = &box->block->payload[box->used];
  ilk_tick_record_t head;
  size_t pairs = HEAD_PAIRS;
  pairs += put_changes(&head, now->pair, box->tick[box->newest ^ 1u].pair, &record[pairs]);
  pairs += put_requests(&record[pairs], requests, count);
  head.words = words_of(pairs);
  head.tick = state->tick;
  head.alarm = ilk_alarm_of(state);
  head.request_count = count;
  split(head.state_hash, ilk_state_hash(state));
  split(head.begun_ns, begun_ns);
  (void)memcpy(record, &head, sizeof head);
  box->used += pairs;
  __atomic_store_n(&box->block->header.used, words_of(box->used), __ATOMIC_RELEASE);
}

/** The store behind the last changed pair is a pair beyond the longest record. */
static bool is_full(const ilk_black_box_t *box) {
  const size_t longest = (ILK_RECORD_WORDS_MAX / WORDS_A_PAIR) + 1u;
  return (box->used + longest) > (ILK_PAYLOAD_WORDS_MAX / WORDS_A_PAIR);
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
  (void)munmap(box->blocks, box->bytes - ILK_RING_HEADER_BYTES);
  (void)munmap(box->ring, ILK_RING_HEADER_BYTES);
  (void)close(box->descriptor);
}
