#include "interlock/replay.h"

#include <stddef.h>
#include <string.h>

void ilk_replay_begin(ilk_replay_t *replay, const ilk_config_t *config) {
  *replay = (ilk_replay_t){.config = config};
}

/** Counts the words of a recorded state that differ, and keeps the first. */
static void compare_state(ilk_difference_t *difference, const ilk_state_t *recorded,
                          const ilk_state_t *replayed) {
  difference->seen_tick = recorded->system.tick;
  for (uint32_t place = 0u; place < sizeof *recorded; place += (uint32_t)sizeof(uint32_t)) {
    uint32_t was = 0u;
    uint32_t is = 0u;
    (void)memcpy(&was, (const unsigned char *)recorded + place, sizeof was);
    (void)memcpy(&is, (const unsigned char *)replayed + place, sizeof is);
    if (was != is) {
      if (difference->words == 0u) {
        difference->offset = (uint32_t)offsetof(ilk_picture_t, state) + place;
        difference->bit = (uint32_t)__builtin_ctz(was ^ is);
        difference->recorded = was;
        difference->replayed = is;
      }
      difference->words += 1u;
    }
  }
}

static void count_tick(ilk_replay_t *replay, const ilk_recorded_tick_t *tick) {
  const uint32_t number = tick->picture.state.system.tick;
  replay->first_tick = replay->ticks == 0u ? number : replay->first_tick;
  replay->last_tick = number;
  replay->ticks += 1u;
  replay->requests += tick->request_count;
}

/** Where the block before ended, or where this one begins; counts a gap between them. */
static void enter_block(ilk_replay_t *replay, uint32_t number, const ilk_state_t *opening) {
  if (replay->next_block != number) {
    replay->gaps += replay->next_block == 0u ? 0u : 1u;
    replay->state = *opening;
  }
  replay->next_block = number + 1u;
}

/** Goes on after a difference: the state to which the block leads shows where it is. */
static ilk_replay_result_t replay_ticks(ilk_replay_t *replay, ilk_block_cursor_t *cursor,
                                        ilk_recorded_tick_t *tick, ilk_difference_t *difference,
                                        ilk_tick_visitor_t visitor, void *context) {
  ilk_replay_result_t result = ILK_REPLAY_IDENTICAL;
  for (;;) {
    const ilk_tick_result_t read = ilk_block_next(cursor, tick);
    if (read == ILK_TICK_NONE) {
      return result;
    }
    if (read == ILK_TICK_DAMAGED) {
      return result == ILK_REPLAY_DIFFERS ? result : ILK_REPLAY_UNREADABLE;
    }
    if (read != ILK_TICK_READ && result == ILK_REPLAY_IDENTICAL) {
      *difference = (ilk_difference_t){.tick = tick->tick, .outputs = read == ILK_TICK_OUTPUTS_DIFFER};
      result = ILK_REPLAY_DIFFERS;
    }
    if (result == ILK_REPLAY_IDENTICAL) {
      count_tick(replay, tick);
      if (visitor != NULL) {
        visitor(context, &replay->state, tick);
      }
    }
    replay->state = tick->picture.state;
  }
}

ilk_replay_result_t ilk_replay_block(ilk_replay_t *replay, uint32_t number, const uint32_t *payload,
                                     uint32_t used, ilk_difference_t *difference, ilk_tick_visitor_t visitor,
                                     void *context) {
  ilk_block_cursor_t cursor;
  ilk_recorded_tick_t tick;
  if (!ilk_block_begin(&cursor, replay->config, payload, used, &tick)) {
    return ILK_REPLAY_UNREADABLE;
  }
  const ilk_state_t *opening = &tick.picture.state;
  enter_block(replay, number, opening);
  *difference = (ilk_difference_t){.tick = opening->system.tick};
  compare_state(difference, opening, &replay->state);
  if (difference->words > 0u) {
    return ILK_REPLAY_DIFFERS;
  }
  const ilk_replay_result_t result = replay_ticks(replay, &cursor, &tick, difference, visitor, context);
  replay->blocks += 1u;
  return result;
}

void ilk_replay_name(const ilk_replay_t *replay, uint32_t number, const uint32_t *payload, uint32_t used,
                     ilk_difference_t *difference) {
  ilk_block_cursor_t cursor;
  ilk_recorded_tick_t opening;
  if ((replay->next_block == number) && ilk_block_begin(&cursor, replay->config, payload, used, &opening)) {
    compare_state(difference, &opening.picture.state, &replay->state);
  }
}

void ilk_replay_recording(ilk_recording_t *recording, ilk_replay_report_t *report, ilk_tick_visitor_t visitor,
                          void *context) {
  *report = (ilk_replay_report_t){.result = ILK_REPLAY_IDENTICAL, .end = ILK_FILE_BLOCK};
  ilk_replay_begin(&report->replay, &recording->header.run.config);
  while (report->result == ILK_REPLAY_IDENTICAL && report->end == ILK_FILE_BLOCK) {
    report->end = ilk_recording_next(recording);
    if (report->end == ILK_FILE_BLOCK) {
      report->result = ilk_replay_block(&report->replay, recording->number, recording->payload,
                                        recording->used, &report->difference, visitor, context);
    }
  }
  if (report->result == ILK_REPLAY_DIFFERS && report->difference.words == 0u &&
      ilk_recording_next(recording) == ILK_FILE_BLOCK) {
    ilk_replay_name(&report->replay, recording->number, recording->payload, recording->used,
                    &report->difference);
  }
}

bool ilk_replay_is_identical(const ilk_replay_report_t *report) {
  return report->result == ILK_REPLAY_IDENTICAL && report->end != ILK_FILE_DAMAGED;
}
