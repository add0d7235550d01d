#include "interlock/recorded_block.h"

#include <string.h>

#include "interlock/kernel.h"

#define GROUP_WORDS 32u

static uint64_t joined(const uint32_t words[2]) { return words[0] | ((uint64_t)words[1] << 32); }

bool ilk_block_begin(ilk_block_cursor_t *cursor, const ilk_config_t *config, const uint32_t *payload,
                     uint32_t used, ilk_recorded_tick_t *tick) {
  *tick = (ilk_recorded_tick_t){0};
  *cursor = (ilk_block_cursor_t){.config = config, .payload = payload, .used = used};
  if (used < ILK_OPENING_WORDS) {
    return false;
  }
  ilk_state_t *state = &tick->picture.state;
  (void)memcpy(state, payload, sizeof *state);
  tick->tick = state->system.tick;
  tick->alarm = ilk_alarm_of(state);
  tick->state_digest = ilk_state_digest(state);
  cursor->place = (uint32_t)ILK_OPENING_WORDS;
  return true;
}

/** The head of the next record, when all of it lies within the block. */
static bool read_head(const ilk_block_cursor_t *cursor, ilk_tick_record_t *head) {
  const uint32_t left = cursor->used - cursor->place;
  if (left < ILK_RECORD_HEAD_WORDS) {
    return false;
  }
  (void)memcpy(head, &cursor->payload[cursor->place], sizeof *head);
  return head->request_count <= (uint32_t)ILK_REQUESTS_PER_TICK && head->words >= ILK_RECORD_HEAD_WORDS &&
         head->words <= left;
}

/** The words of a group that were not expected; returns how many, or more than are left. */
static uint32_t read_group(uint32_t given[], const uint32_t from[], uint32_t left, uint32_t missed) {
  uint32_t taken = 0u;
  for (uint32_t rest = missed; (rest != 0u) && (taken < left); rest &= rest - 1u) {
    given[__builtin_ctz(rest)] = from[taken];
    taken += 1u;
  }
  return taken;
}

/** Puts what the record says in the place of what was expected. False when it is not as long as its head
 * says. */
static bool read_given(uint32_t given[], uint32_t count, const ilk_tick_record_t *head,
                       const uint32_t record[]) {
  const uint32_t groups = (uint32_t)__builtin_popcount(head->groups);
  if (head->words < (ILK_RECORD_HEAD_WORDS + groups)) {
    return false;
  }
  const uint32_t *missed = &record[ILK_RECORD_HEAD_WORDS];
  uint32_t place = (uint32_t)ILK_RECORD_HEAD_WORDS + groups;
  for (uint32_t rest = head->groups; rest != 0u; rest &= rest - 1u) {
    const uint32_t first = (uint32_t)__builtin_ctz(rest) * GROUP_WORDS;
    const uint32_t last = first + (GROUP_WORDS - 1u) - (uint32_t)__builtin_clz(*missed | 1u);
    const uint32_t needed = (uint32_t)__builtin_popcount(*missed);
    if ((last >= count) || (needed > (head->words - place))) {
      return false;
    }
    place += read_group(&given[first], &record[place], needed, *missed);
    missed += 1;
  }
  return place == head->words;
}

/** What the record of the next tick gave to the kernel; what follows is expected from it. */
static bool take_given(ilk_block_cursor_t *cursor, const ilk_tick_record_t *head, ilk_recorded_tick_t *tick) {
  uint32_t given[ILK_GIVEN_WORDS];
  uint32_t missed[ILK_GIVEN_WORDS];
  ilk_expectation_t *expected = &cursor->expected;
  const uint32_t count = ilk_given_words(head->request_count);
  for (uint32_t i = 0u; i < count; ++i) {
    given[i] = expected->newest[i] + expected->step[i];
  }
  if (!read_given(given, count, head, &cursor->payload[cursor->place])) {
    return false;
  }
  ilk_expectation_follow(expected, given, count, missed);
  ilk_given_to_inputs(given, &tick->picture.inputs);
  (void)memset(tick->request, 0, sizeof tick->request);
  (void)memcpy(tick->request, &given[ILK_INPUT_WORDS], head->request_count * sizeof(ilk_request_t));
  return true;
}

ilk_tick_result_t ilk_block_next(ilk_block_cursor_t *cursor, ilk_recorded_tick_t *tick) {
  ilk_tick_record_t head;
  if (cursor->place == cursor->used) {
    return ILK_TICK_NONE;
  }
  if (!read_head(cursor, &head) || !take_given(cursor, &head, tick)) {
    return ILK_TICK_DAMAGED;
  }
  ilk_picture_t *picture = &tick->picture;
  ilk_step(cursor->config, &picture->state, &picture->inputs, tick->request, head.request_count,
           &picture->out);
  tick->request_count = head.request_count;
  tick->tick = head.tick;
  tick->alarm = head.alarm;
  tick->begun_ns = joined(head.begun_ns);
  tick->state_digest = joined(head.state_digest);
  cursor->place += head.words;
  const ilk_state_t *state = &picture->state;
  if (head.tick != state->system.tick || head.alarm != ilk_alarm_of(state) ||
      tick->state_digest != ilk_state_digest(state)) {
    return ILK_TICK_STATE_DIFFERS;
  }
  return head.out_digest == ilk_out_digest(&picture->out) ? ILK_TICK_READ : ILK_TICK_OUTPUTS_DIFFER;
}
