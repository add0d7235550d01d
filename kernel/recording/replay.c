#include "interlock/replay.h"

#include <stddef.h>
#include <string.h>

#include "interlock/kernel.h"

void ilk_replay_begin(ilk_replay_t *replay, const ilk_config_t *config) {
  *replay = (ilk_replay_t){.config = config};
}

/** Adds the words of one part of the picture that differ; the first of all is kept. */
static void compare(ilk_difference_t *difference, uint32_t part_offset, const void *recorded,
                    const void *replayed, uint32_t bytes) {
  for (uint32_t place = 0u; place < bytes; place += (uint32_t)sizeof(uint32_t)) {
    uint32_t was = 0u;
    uint32_t is = 0u;
    (void)memcpy(&was, (const unsigned char *)recorded + place, sizeof was);
    (void)memcpy(&is, (const unsigned char *)replayed + place, sizeof is);
    if (was != is) {
      if (difference->words == 0u) {
        difference->offset = part_offset + place;
        difference->bit = (uint32_t)__builtin_ctz(was ^ is);
        difference->recorded = was;
        difference->replayed = is;
      }
      difference->words += 1u;
    }
  }
}

static void compare_state(ilk_difference_t *difference, const ilk_state_t *recorded,
                          const ilk_state_t *replayed) {
  *difference = (ilk_difference_t){.tick = recorded->tick};
  compare(difference, (uint32_t)offsetof(ilk_picture_t, state), recorded, replayed,
          (uint32_t)sizeof *recorded);
}

/** Steps the kernel as the record says, and compares what comes out. */
static void replay_tick(ilk_replay_t *replay, const ilk_recorded_tick_t *tick, ilk_difference_t *difference) {
  const ilk_picture_t *picture = &tick->now.picture;
  ilk_outputs_t out;
  ilk_step(replay->config, &replay->state, &picture->inputs, tick->request, tick->request_count, &out);
  compare_state(difference, &picture->state, &replay->state);
  compare(difference, (uint32_t)offsetof(ilk_picture_t, out), &picture->out, &out, (uint32_t)sizeof out);
}

static void count_tick(ilk_replay_t *replay, const ilk_recorded_tick_t *tick) {
  const uint32_t number = tick->now.picture.state.tick;
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

ilk_replay_result_t ilk_replay_block(ilk_replay_t *replay, uint32_t number, const uint32_t *payload,
                                     uint32_t used, ilk_difference_t *difference, ilk_tick_visitor_t visitor,
                                     void *context) {
  ilk_block_cursor_t cursor;
  ilk_recorded_tick_t tick;
  if (!ilk_block_begin(&cursor, payload, used, &tick)) {
    return ILK_REPLAY_UNREADABLE;
  }
  enter_block(replay, number, &tick.now.picture.state);
  compare_state(difference, &tick.now.picture.state, &replay->state);
  while (difference->words == 0u) {
    const ilk_tick_result_t read = ilk_block_next(&cursor, &tick);
    if (read != ILK_TICK_READ) {
      replay->blocks += 1u;
      return read == ILK_TICK_NONE ? ILK_REPLAY_IDENTICAL : ILK_REPLAY_UNREADABLE;
    }
    replay_tick(replay, &tick, difference);
    if (difference->words == 0u) {
      count_tick(replay, &tick);
      if (visitor != NULL) {
        visitor(context, &tick);
      }
    }
  }
  return ILK_REPLAY_DIFFERS;
}

void ilk_replay_recording(ilk_recording_t *recording, ilk_replay_report_t *report, ilk_tick_visitor_t visitor,
                          void *context) {
  *report = (ilk_replay_report_t){.result = ILK_REPLAY_IDENTICAL, .end = ILK_FILE_BLOCK};
  ilk_replay_begin(&report->replay, &recording->header.run.config);
  while (report->result == ILK_REPLAY_IDENTICAL && report->end == ILK_FILE_BLOCK) {
    report->end = ilk_recording_next(recording);
    if (report->end == ILK_FILE_BLOCK) {
      report->result = ilk_replay_block(&report->replay, recording->number, ilk_recording_payload(recording),
                                        recording->used, &report->difference, visitor, context);
    }
  }
}

bool ilk_replay_is_identical(const ilk_replay_report_t *report) {
  return report->result == ILK_REPLAY_IDENTICAL && report->end != ILK_FILE_DAMAGED;
}
