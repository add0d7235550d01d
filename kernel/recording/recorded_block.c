#include "interlock/recorded_block.h"

#include <string.h>

#define RECORD_HEAD_WORDS ((uint32_t)(sizeof(ilk_tick_record_t) / sizeof(uint32_t)))
#define REQUEST_WORDS ((uint32_t)(sizeof(ilk_request_t) / sizeof(uint32_t)))

static uint64_t joined(const uint32_t words[2]) { return words[0] | ((uint64_t)words[1] << 32); }

bool ilk_block_begin(ilk_block_cursor_t *cursor, const uint32_t *payload, uint32_t used,
                     ilk_recorded_tick_t *tick) {
  *tick = (ilk_recorded_tick_t){0};
  *cursor = (ilk_block_cursor_t){.payload = payload, .used = used};
  if (used < ILK_OPENING_WORDS) {
    return false;
  }
  (void)memcpy(tick->now.pair, payload, sizeof tick->now);
  tick->alarm = ilk_alarm_of(&tick->now.picture.state);
  tick->state_hash = ilk_state_hash(&tick->now.picture.state);
  cursor->place = (uint32_t)ILK_OPENING_WORDS;
  return true;
}

static uint32_t changed_pairs(const ilk_tick_record_t *head) {
  uint32_t count = 0u;
  for (uint32_t word = 0u; word < ILK_CHANGED_WORDS; ++word) {
    count += (uint32_t)__builtin_popcount(head->changed[word]);
  }
  return count;
}

/** Words of a record with this head: the changed pairs, the requests, made even. */
static uint32_t words_of(const ilk_tick_record_t *head) {
  const uint32_t words =
      RECORD_HEAD_WORDS + (2u * changed_pairs(head)) + (head->request_count * REQUEST_WORDS);
  return words + (words & 1u);
}

/** The head of the next record, when all of it lies within the block. */
static bool read_head(const ilk_block_cursor_t *cursor, ilk_tick_record_t *head) {
  const uint32_t left = cursor->used - cursor->place;
  if (left < RECORD_HEAD_WORDS) {
    return false;
  }
  (void)memcpy(head, &cursor->payload[cursor->place], sizeof *head);
  return head->request_count <= (uint32_t)ILK_REQUESTS_PER_TICK && head->words <= left &&
         head->words == words_of(head);
}

/** Returns the place behind the last changed pair. */
static const uint32_t *take_changes(ilk_picture_pairs_t *picture, const ilk_tick_record_t *head,
                                    const uint32_t *from) {
  for (uint32_t pair = 0u; pair < ILK_PAIRS; ++pair) {
    if (((head->changed[pair / 32u] >> (pair % 32u)) & 1u) != 0u) {
      (void)memcpy(&picture->pair[pair], from, sizeof(uint64_t));
      from += 2;
    }
  }
  return from;
}

ilk_tick_result_t ilk_block_next(ilk_block_cursor_t *cursor, ilk_recorded_tick_t *tick) {
  ilk_tick_record_t head;
  if (cursor->place == cursor->used) {
    return ILK_TICK_NONE;
  }
  if (!read_head(cursor, &head)) {
    return ILK_TICK_DAMAGED;
  }
  const uint32_t *from = take_changes(&tick->now, &head, &cursor->payload[cursor->place + RECORD_HEAD_WORDS]);
  (void)memset(tick->request, 0, sizeof tick->request);
  (void)memcpy(tick->request, from, head.request_count * sizeof(ilk_request_t));
  tick->request_count = head.request_count;
  tick->alarm = head.alarm;
  tick->begun_ns = joined(head.begun_ns);
  tick->state_hash = joined(head.state_hash);
  cursor->place += head.words;
  const ilk_state_t *state = &tick->now.picture.state;
  const bool agrees = head.tick == state->tick && head.alarm == ilk_alarm_of(state) &&
                      tick->state_hash == ilk_state_hash(state);
  return agrees ? ILK_TICK_READ : ILK_TICK_DAMAGED;
}
