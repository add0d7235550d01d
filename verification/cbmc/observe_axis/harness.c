/**
 * @file
 * Phase 4 for an arbitrary axis: every field after the observation as a function of those before, the
 * configuration, the reading and the tick, as kernel.md ("Axes") has it.
 */
#include "axis.h"
#include "proof.h"
#include "sound.h"
#include "stand_ins.h"

/** What was found, in the order in which one rule comes before another; NONE when all is well. */
typedef struct {
  uint32_t fault;
  int64_t value;
} finding_t;

static bool enabled(const ilk_axis_t* axis) {
  return (axis->state == ILK_AXIS_ENABLED) || (axis->state == ILK_AXIS_MOVING) ||
         (axis->state == ILK_AXIS_HOMING);
}

static int64_t progress(const ilk_axis_config_t* config, const ilk_axis_t* axis, uint32_t mark,
                        uint32_t direction) {
  return held(directed(direction, some_travel(config, mark, axis->raw)));
}

/** A card that is new brings no motion: its first reading is the mark of everything. */
static void start_from(ilk_axis_t* axis, uint32_t raw) {
  axis->card_seen = 1u;
  axis->raw = raw;
  axis->ticks_since_frame = 0u;
  axis->reverse_mark_raw = raw;
  axis->drift_mark_raw = raw;
  axis->stall_mark_raw = raw;
  axis->homing_mark_raw = raw;
}

static void follow(const ilk_axis_config_t* config, ilk_axis_t* axis, uint32_t raw) {
  if (axis->card_seen == 0u) {
    start_from(axis, raw);
  }
  axis->delta_counts = some_travel(config, axis->raw, raw);
  axis->position_counts = some_sum(axis->position_counts, axis->delta_counts);
  axis->press_travel_counts = some_sum(axis->press_travel_counts, axis->delta_counts);
  axis->raw = raw;
}

/** An axis that was driven since its last valid frame was driven in the tick of that frame. */
static void count_undriven(const ilk_axis_config_t* config, ilk_axis_t* axis) {
  const bool driven_last_tick =
      (axis->driven_direction != ILK_DIRECTION_NONE) && (axis->ticks_since_frame == 1u);
  axis->undriven_ticks =
      driven_last_tick ? 0u : (uint32_t)one_more(axis->undriven_ticks, config->settle_ticks);
}

/** The frame that tells of a drive tells what it did, even when others were missed before it. */
static bool has_settled(const ilk_axis_config_t* config, const ilk_axis_t* axis) {
  return (axis->driven_direction == ILK_DIRECTION_NONE) && (axis->undriven_ticks >= config->settle_ticks);
}

/** The farthest point in the driven direction, progress before the axis had settled, and where it settled. */
static void move_marks(const ilk_axis_config_t* config, ilk_axis_t* axis) {
  const int64_t onward = progress(config, axis, axis->stall_mark_raw, axis->stall_direction);
  if (progress(config, axis, axis->reverse_mark_raw, axis->reverse_direction) > 0) {
    axis->reverse_mark_raw = axis->raw;
  }
  if (!has_settled(config, axis) && (onward > 0) && (onward >= (int64_t)config->stall_min_counts)) {
    axis->stall_driven_ticks = 0u;
    axis->setpoint_changed = 0u;
    axis->stall_mark_raw = axis->raw;
  }
  if (!enabled(axis) || !has_settled(config, axis)) {
    axis->drift_mark_raw = axis->raw;
  }
}

static finding_t judge(const ilk_axis_config_t* config, const ilk_axis_t* axis) {
  const int64_t reach = some_product(config->max_delta_counts, axis->ticks_since_frame);
  const int64_t onward = progress(config, axis, axis->reverse_mark_raw, axis->reverse_direction);
  const int64_t drift = some_travel(config, axis->drift_mark_raw, axis->raw);
  const bool driven = axis->driven_direction != ILK_DIRECTION_NONE;
  finding_t found = {ILK_FAULT_NONE, 0};
  if (distance(axis->delta_counts) > reach) {
    found = (finding_t){ILK_FAULT_JUMP, axis->delta_counts};
  } else if (driven && (-onward > (int64_t)config->reverse_counts)) {
    found = (finding_t){ILK_FAULT_REVERSE, held(-onward)};
  } else if (enabled(axis) && has_settled(config, axis) &&
             (distance(drift) > (int64_t)config->drift_counts)) {
    found = (finding_t){ILK_FAULT_DRIFT, drift};
  } else if (enabled(axis) && (axis->stall_driven_ticks >= config->stall_ticks)) {
    found = (finding_t){ILK_FAULT_STALL, progress(config, axis, axis->stall_mark_raw, axis->stall_direction)};
  }
  return found;
}

static void next_phase(ilk_axis_t* axis, uint32_t phase) {
  axis->homing_phase = phase;
  axis->homing_mark_raw = axis->raw;
  axis->rest_ticks = 0u;
}

/** The switch seen open, then the switch, then rest; each by a valid frame. */
static void home(const ilk_axis_config_t* config, ilk_axis_t* axis) {
  const bool at_switch = axis->switch_triggered != 0u;
  if ((axis->homing_phase == ILK_HOMING_BACK_OFF) && !at_switch) {
    next_phase(axis, ILK_HOMING_SEEK);
  } else if ((axis->homing_phase == ILK_HOMING_SEEK) && at_switch) {
    axis->position_counts = config->home_offset_counts;
    next_phase(axis, ILK_HOMING_REST);
  } else if (axis->homing_phase == ILK_HOMING_REST) {
    axis->rest_ticks =
        (axis->delta_counts == 0) ? (uint32_t)one_more(axis->rest_ticks, config->home_rest_ticks) : 0u;
    if (axis->rest_ticks >= config->home_rest_ticks) {
      next_phase(axis, ILK_HOMING_NONE);
      axis->state = ILK_AXIS_ENABLED;
      axis->homed = 1u;
    }
  }
}

static finding_t judge_homing(const ilk_axis_config_t* config, const ilk_axis_t* axis) {
  const int64_t travel = some_travel(config, axis->homing_mark_raw, axis->raw);
  const bool backing = axis->homing_phase == ILK_HOMING_BACK_OFF;
  const int64_t bound = backing ? config->home_backoff_counts : config->home_travel_counts;
  finding_t found = {ILK_FAULT_NONE, 0};
  if (distance(travel) > bound) {
    found = (finding_t){ILK_FAULT_HOMING_TRAVEL, travel};
  } else if (axis->homing_ticks == 0u) {
    found = (finding_t){ILK_FAULT_HOMING_TIMEOUT, axis->homing_phase};
  }
  return found;
}

/** Undriven, with nothing of a move left; the first fault stays. */
static void fault(ilk_axis_t* axis, finding_t found, uint32_t tick) {
  if (axis->state != ILK_AXIS_FAULTED) {
    axis->state = ILK_AXIS_FAULTED;
    axis->fault = found.fault;
    axis->fault_value = (int32_t)found.value;
    axis->fault_tick = tick;
    axis->setpoint_counts = 0;
    axis->drive = 0u;
    axis->amplitude = 0u;
    axis->lease_ticks = 0u;
    axis->homing_phase = ILK_HOMING_NONE;
    axis->setpoint_changed = (axis->stall_driven_ticks != 0u) ? 1u : axis->setpoint_changed;
  }
  if ((found.fault == ILK_FAULT_JUMP) || (found.fault == ILK_FAULT_CARD_LOST) ||
      (found.fault == ILK_FAULT_HOMING_TRAVEL) || (found.fault == ILK_FAULT_HOMING_TIMEOUT)) {
    axis->homed = 0u;
  }
}

/** The axis after this tick's observation. */
static ilk_axis_t expected_after(const ilk_config_t* config, const ilk_axis_config_t* axis_config,
                                 const ilk_axis_t* before, const ilk_reading_t* reading, uint32_t tick) {
  const bool valid = before->card_valid != 0u;
  ilk_axis_t axis = *before;
  finding_t found = {ILK_FAULT_NONE, 0};
  axis.switch_triggered =
      ((axis_config->limit_side != ILK_LIMIT_NONE) && (!valid || reading->switch_triggered)) ? 1u : 0u;
  axis.lease_ticks = (uint32_t)one_less(axis.lease_ticks);
  axis.state = ((axis.state == ILK_AXIS_MOVING) && (axis.lease_ticks == 0u)) ? ILK_AXIS_ENABLED : axis.state;
  count_undriven(axis_config, &axis);
  if (valid) {
    follow(axis_config, &axis, reading->raw);
    move_marks(axis_config, &axis);
    found = judge(axis_config, &axis);
    axis.driven_direction = ILK_DIRECTION_NONE;
  } else if (axis.bad_frames >= config->bad_frame_limit) {
    axis.card_seen = 0u;
    found = (finding_t){ILK_FAULT_CARD_LOST, (int64_t)axis.bad_frames & INT32_MAX};
  }
  if (axis.state == ILK_AXIS_HOMING) {
    axis.homing_ticks = (uint32_t)one_less(axis.homing_ticks);
    if (valid) {
      home(axis_config, &axis);
    }
  }
  /* The axis' own fault comes before that of its homing. */
  if ((axis.state == ILK_AXIS_HOMING) && (found.fault == ILK_FAULT_NONE)) {
    found = judge_homing(axis_config, &axis);
  }
  if (found.fault != ILK_FAULT_NONE) {
    fault(&axis, found, tick);
  }
  return axis;
}

#define SAME(field, text) SHOW(after.field == expected.field, text)

void harness(void) {
  ilk_config_t config;
  ilk_axis_config_t axis_config;
  ilk_axis_t axis;
  uint32_t mode;
  ilk_reading_t reading;
  uint32_t tick;
  uint32_t switch_bits;
  reading.switch_triggered = switch_bits != 0u;
  GIVEN(sound_axis(&axis, mode));

  const ilk_axis_t before = axis;
  const ilk_axis_t expected = expected_after(&config, &axis_config, &before, &reading, tick);
  const bool faulted = ilk_observe_axis(&config, &axis_config, &axis, &reading, tick);
  const ilk_axis_t after = axis;
  const bool valid = before.card_valid != 0u;

  SHOW(sound_axis(&after, mode), "P15: the invariant is kept");
  SHOW(faulted == ((after.state == ILK_AXIS_FAULTED) && (before.state != ILK_AXIS_FAULTED)),
       "P6: a new fault is told, and only that");
  SAME(state, "P5, P6, P8: the state, and whether a rule faults it now");
  SAME(fault, "P6, P8: which rule comes first, and the first fault stays");
  SAME(fault_tick, "P8: the tick of the first fault stays");
  SAME(fault_value, "P6: what was measured");
  SAME(homed, "P6: what loses the reference, and homing alone gives it");
  SAME(switch_triggered, "P3: a switch that was not read validly counts as triggered");
  SAME(card_valid, "P1: the card's validity is not its own to change");
  SAME(card_seen, "a lost card is new when it comes back");
  SAME(ticks_since_frame, "P6: ticks since the valid frame before, none at a card's first");
  SAME(raw, "the last valid reading");
  SAME(position_counts, "P4: the position follows the counter, or is set at the switch");
  SAME(delta_counts, "P6: motion since the last valid frame");
  SAME(press_travel_counts, "P7: travel since the pedal was pressed");
  SAME(lease_ticks, "P1: the lease runs down by one a tick");
  SAME(driven_direction, "P6: the driven direction lasts until the next valid frame");
  SAME(stall_driven_ticks, "P5: only progress in the commanded direction clears the count");
  SAME(stall_mark_raw, "P5: progress is measured from where the count began");
  SAME(setpoint_changed, "P5: a setpoint that changed while the count ran");
  SAME(reverse_mark_raw, "P6: the farthest point reached");
  SAME(drift_mark_raw, "P6: where the axis had settled");
  SAME(undriven_ticks, "P6: ticks since the last driven one");
  SAME(homing_phase, "homing: the switch seen open, then triggered, then rest");
  SAME(homing_ticks, "homing is bounded in time");
  SAME(homing_mark_raw, "homing is bounded in travel");
  SAME(rest_ticks, "homing waits until the counter rests");
  SHOW((after.setpoint_counts == expected.setpoint_counts) && (after.drive == expected.drive) &&
           (after.amplitude == expected.amplitude),
       "the move is kept, or dropped by a fault");
  SHOW((after.bad_frames == before.bad_frames) && (after.checksum_failures == before.checksum_failures) &&
           (after.heartbeat == before.heartbeat) && (after.card_time_us == before.card_time_us) &&
           (after.card_status == before.card_status) && (after.stall_direction == before.stall_direction) &&
           (after.reverse_direction == before.reverse_direction),
       "nothing else changes");
  SHOW(!valid || !enabled(&after) || (after.stall_driven_ticks < axis_config.stall_ticks),
       "P5: an axis that may be driven has made progress within stall_ticks");

  GOAL(goal_stall, faulted && (after.fault == ILK_FAULT_STALL));
  GOAL(goal_reverse, faulted && (after.fault == ILK_FAULT_REVERSE));
  GOAL(goal_drift, faulted && (after.fault == ILK_FAULT_DRIFT));
  GOAL(goal_jump, faulted && (after.fault == ILK_FAULT_JUMP));
  GOAL(goal_card_lost, faulted && (after.fault == ILK_FAULT_CARD_LOST));
  GOAL(goal_homing_travel, faulted && (after.fault == ILK_FAULT_HOMING_TRAVEL));
  GOAL(goal_homing_timeout, faulted && (after.fault == ILK_FAULT_HOMING_TIMEOUT));
  GOAL(goal_homed, (before.homed == 0u) && (after.homed == 1u));
  GOAL(goal_at_switch, (before.homing_phase == ILK_HOMING_SEEK) && (after.homing_phase == ILK_HOMING_REST));
  GOAL(goal_switch_opens,
       (before.homing_phase == ILK_HOMING_BACK_OFF) && (after.homing_phase == ILK_HOMING_SEEK));
  GOAL(goal_counter_wraps, (before.raw > after.raw) && (after.delta_counts > 0) &&
                               (axis_config.direction_correction == 0u) && (after.state == ILK_AXIS_MOVING));
  GOAL(goal_lease_ends, (before.state == ILK_AXIS_MOVING) && (after.state == ILK_AXIS_ENABLED));
  GOAL(goal_progress_clears_the_count, (before.stall_driven_ticks > 1u) && (after.stall_driven_ticks == 0u));
  GOAL(goal_faulted_axis_loses_reference,
       (before.state == ILK_AXIS_FAULTED) && (before.homed == 1u) && (after.homed == 0u));
  GOAL(never_unfaulted, (before.state == ILK_AXIS_FAULTED) && (after.state != ILK_AXIS_FAULTED));
  GOAL(never_a_longer_lease, after.lease_ticks > before.lease_ticks);
  GOAL(never_homed_with_a_fault_of_homing,
       (after.homed == 1u) && faulted && (after.fault == ILK_FAULT_HOMING_TRAVEL));
}
