/**
 * @file
 * Phase 2 of one card: when its frame is valid, and what is remembered of it; and sensor cards in phase 4.
 */
#include "axis.h"
#include "axis_effects.h"
#include "counts.h"
#include "proof.h"
#include "sound.h"

/** Fresh: the heartbeat moved on, and the card has heard the frame of two ticks ago (decision 3). */
static bool is_valid(const ilk_axis_t* axis, const ilk_reading_t* reading, bool received, uint32_t tick) {
  const int64_t heard = (int64_t)tick - 2;
  const bool moved_on = (axis->card_seen == 0u) || (axis->heartbeat != reading->heartbeat);
  return received && reading->intact && moved_on && ((heard < 0) || (heard == (int64_t)reading->tick_echo));
}

static ilk_axis_t expect_card(ilk_axis_t axis, const ilk_reading_t* reading, bool received, uint32_t tick) {
  const bool valid = is_valid(&axis, reading, received, tick);
  axis.checksum_failures = (received && !reading->intact)
                               ? (uint32_t)one_more(axis.checksum_failures, UINT32_MAX)
                               : axis.checksum_failures;
  axis.ticks_since_frame =
      (axis.card_valid != 0u) ? 1u : (uint32_t)one_more(axis.ticks_since_frame, UINT32_MAX);
  axis.card_valid = valid ? 1u : 0u;
  axis.bad_frames = valid ? 0u : (uint32_t)one_more(axis.bad_frames, UINT32_MAX);
  if (valid) {
    axis.heartbeat = reading->heartbeat;
    axis.card_time_us = reading->card_time_us;
    axis.card_status = reading->card_status;
  }
  return axis;
}

void harness(void) {
  ilk_config_t config;
  ilk_axis_t axis;
  ilk_reading_t reading;
  uint32_t tick;
  uint32_t bits;
  reading.intact = (bits & 1u) != 0u;
  reading.switch_triggered = (bits & 2u) != 0u;
  const bool received = (bits & 4u) != 0u;
  GIVEN(sound_axis_alone(&axis));

  const ilk_axis_t before = axis;
  ilk_axis_t expected = expect_card(before, &reading, received, tick);
  ilk_observe_card(&axis, &reading, received, tick);
  show_same_axis(&axis, &expected);
  SHOW(sound_axis_alone(&axis), "P15: the invariant is kept");
  SHOW((axis.card_valid == 0u) || (received && reading.intact),
       "P16: a frame that is not intact is never used");
  SHOW((before.card_seen == 0u) || (axis.card_valid == 0u) || (before.heartbeat != reading.heartbeat),
       "P1: a repeated frame is not valid");
  SHOW(ilk_card_is_lost(&config, &axis) == (axis.bad_frames >= config.bad_frame_limit),
       "P6: a card is lost after bad_frame_limit bad frames in a row");

  const ilk_axis_t observed = axis;
  expected = observed;
  if (observed.card_valid != 0u) {
    expected.card_seen = 1u;
  } else if (observed.bad_frames >= config.bad_frame_limit) {
    expected.card_seen = 0u;
  }
  ilk_observe_sensor(&config, &axis);
  show_same_axis(&axis, &expected);
  SHOW(sound_axis_alone(&axis), "P15: the invariant is kept for a sensor");

  GOAL(goal_valid, (axis.card_valid == 1u) && (tick > 2u));
  GOAL(goal_first_frames, (axis.card_valid == 1u) && (tick < 2u) && (reading.tick_echo == 77u));
  GOAL(goal_late,
       received && reading.intact && (before.heartbeat != reading.heartbeat) && (axis.card_valid == 0u));
  GOAL(goal_repeated,
       received && reading.intact && (reading.tick_echo == 5u) && (tick == 7u) && (axis.card_valid == 0u));
  GOAL(goal_bad_checksum, before.checksum_failures < axis.checksum_failures);
  GOAL(goal_lost, (before.card_seen == 1u) && (axis.card_seen == 0u));
  GOAL(never_valid_unless_received, (axis.card_valid == 1u) && !received);
}
