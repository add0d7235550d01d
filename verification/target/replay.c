/**
 * @file
 * Replays a recording on this machine: "identical", or the first bit that differs.
 */
#include "interlock/replay.h"

#include <stdio.h>

#include "counts.h"
#include "platform.h"

static ilk_recording_t recording;
static ilk_replay_report_t report;
static counts_t counts;

static void count(void *context, const ilk_state_t *before, const ilk_recorded_tick_t *tick) {
  (void)context;
  (void)before;
  count_tick(&counts, &tick->picture.state, &tick->picture.out);
}

static void say_difference(const ilk_difference_t *difference) {
  say("differs tick ");
  say_number(difference->tick);
  say(difference->outputs ? " outputs" : " state");
  if (difference->words > 0u) {
    say(", at tick ");
    say_number(difference->seen_tick);
    say(" ");
    say(ilk_word_name(ilk_picture_fields(), difference->offset).text);
    say(" bit ");
    say_number(difference->bit);
  }
  say("\n");
}

uint32_t run_image(void) {
  FILE *file = fopen(RECORDING, "rb");
  if (file == NULL || ilk_recording_begin(&recording, file) != ILK_HEADER_GOOD) {
    say("no recording of this release\n");
    return 1u;
  }
  ilk_replay_recording(&recording, &report, count, NULL);
  (void)fclose(file);
  say_counts(&counts);
  say("ticks ");
  say_number((uint32_t)report.replay.ticks);
  say("\n");
  if (report.result == ILK_REPLAY_DIFFERS) {
    say_difference(&report.difference);
  }
  if (!ilk_replay_is_identical(&report)) {
    return 1u;
  }
  say("identical\n");
  return 0u;
}
