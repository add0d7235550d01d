/**
 * @file
 * What an accepted request does to the axis that it names, field by field. One axis stands for each: which
 * one is acted upon is shown in `requests`.
 */
#include "axis_effects.h"
#include "proof.h"
#include "request.c"
#include "request_table.h"
#include "sound.h"

static void set_motion(ilk_axis_t* axis, const ilk_request_t* request) {
  const bool other_target = axis->setpoint_counts != request->target_counts;
  axis->setpoint_changed = (other_target && (axis->stall_driven_ticks != 0u)) ? 1u : axis->setpoint_changed;
  axis->state = ILK_AXIS_MOVING;
  axis->setpoint_counts = request->target_counts;
  axis->drive = request->drive;
  axis->amplitude = request->amplitude;
  axis->lease_ticks = request->lease_ticks;
}

static void begin_homing(const ilk_axis_config_t* config, ilk_axis_t* axis) {
  axis->state = ILK_AXIS_HOMING;
  axis->homed = 0u;
  axis->lease_ticks = 0u;
  axis->homing_phase = (axis->switch_triggered != 0u) ? ILK_HOMING_BACK_OFF : ILK_HOMING_SEEK;
  axis->homing_ticks = config->home_timeout_ticks;
  axis->homing_mark_raw = axis->raw;
  axis->rest_ticks = 0u;
}

/** P5: only a stall excuses an axis from the ticks that it was driven without progress. */
static void clear_fault(ilk_axis_t* axis) {
  const bool stalled = axis->fault == ILK_FAULT_STALL;
  axis->state = ILK_AXIS_DISABLED;
  axis->fault = ILK_FAULT_NONE;
  axis->fault_tick = 0u;
  axis->fault_value = 0;
  axis->stall_driven_ticks = stalled ? 0u : axis->stall_driven_ticks;
  axis->setpoint_changed = stalled ? 0u : axis->setpoint_changed;
}

static ilk_axis_t expect_axis(const ilk_axis_config_t* config, ilk_axis_t axis,
                              const ilk_request_t* request) {
  switch (request->kind) {
    case ILK_REQUEST_DISABLE:
      axis = disabled(axis);
      break;
    case ILK_REQUEST_ENABLE:
      axis.state = (axis.state == ILK_AXIS_DISABLED) ? ILK_AXIS_ENABLED : axis.state;
      break;
    case ILK_REQUEST_CLEAR_FAULT:
      clear_fault(&axis);
      break;
    case ILK_REQUEST_MOVE:
      set_motion(&axis, request);
      break;
    case ILK_REQUEST_HOME:
      begin_homing(config, &axis);
      break;
    case ILK_REQUEST_SET_HOME:
      axis.position_counts = 0;
      axis.homed = 1u;
      break;
    case ILK_REQUEST_RESTORE:
      axis.position_counts = request->target_counts;
      axis.homed = 0u;
      break;
    default: /* no such request */
      break;
  }
  return axis;
}

void harness(void) {
  ilk_config_t config;
  ilk_axis_config_t limits;
  ilk_state_t state; /* only its words of the system count */
  ilk_axis_t axis;
  ilk_request_t request;
  const ilk_axis_t before = axis;
  const ilk_axis_t expected = expect_axis(&limits, before, &request);
  apply_to_axis(&limits, &axis, &request);
  show_same_axis(&axis, &expected);

  const bool known = (request.kind >= ILK_REQUEST_DISABLE) && (request.kind <= ILK_REQUEST_RESTORE);
  const bool allowed =
      known && (check_axis(&config, &limits, &state, &before, &request) == ILK_VERDICT_ACCEPTED);
  SHOW(!allowed || !sound_axis(&before, state.mode) || sound_axis(&axis, state.mode),
       "P15: what the table allows keeps the invariant");
  SHOW(!allowed || (before.state != ILK_AXIS_FAULTED) || (axis.state == ILK_AXIS_FAULTED) ||
           ((request.kind == ILK_REQUEST_CLEAR_FAULT) && (axis.state == ILK_AXIS_DISABLED)),
       "P8: a fault is left only by CLEAR_FAULT, into DISABLED");
  SHOW((axis.reverse_mark_raw == before.reverse_mark_raw) && (axis.drift_mark_raw == before.drift_mark_raw) &&
           (axis.stall_mark_raw == before.stall_mark_raw) && (axis.raw == before.raw),
       "P6: no request moves a mark of runaway or stall");
  SHOW(!allowed || (axis.lease_ticks <= config.lease_max_ticks) || (axis.lease_ticks == before.lease_ticks),
       "P1: no lease is longer than lease_max_ticks");
  SHOW(!allowed || (request.kind != ILK_REQUEST_MOVE) ||
           (axis.drive <= ((axis.homed != 0u) ? limits.max_drive : limits.unhomed_max_drive)),
       "P7: no move asks for more drive than the axis may have");

  GOAL(goal_disable, allowed && (request.kind == ILK_REQUEST_DISABLE) && (before.state == ILK_AXIS_HOMING));
  GOAL(goal_enable, allowed && (before.state == ILK_AXIS_DISABLED) && (axis.state == ILK_AXIS_ENABLED));
  GOAL(goal_enable_again, allowed && (request.kind == ILK_REQUEST_ENABLE) && (axis.state == ILK_AXIS_MOVING));
  GOAL(goal_clear_stall, allowed && (before.fault == ILK_FAULT_STALL) && (axis.stall_driven_ticks == 0u));
  GOAL(goal_clear_other, allowed && (before.fault == ILK_FAULT_JUMP) && (axis.stall_driven_ticks == 7u) &&
                             (axis.fault == ILK_FAULT_NONE));
  GOAL(goal_move_homed, allowed && (request.kind == ILK_REQUEST_MOVE) && (axis.homed == 1u));
  GOAL(goal_move_again, allowed && (before.state == ILK_AXIS_MOVING) && (axis.setpoint_changed == 1u) &&
                            (before.setpoint_changed == 0u));
  GOAL(goal_home_from_the_switch,
       allowed && (axis.homing_phase == ILK_HOMING_BACK_OFF) && (before.state == ILK_AXIS_MOVING));
  GOAL(goal_set_home, allowed && (request.kind == ILK_REQUEST_SET_HOME) && (before.homed == 0u));
  GOAL(goal_restore, allowed && (request.kind == ILK_REQUEST_RESTORE) && (axis.position_counts == -9));
  GOAL(never_home_and_homed,
       allowed && (axis.state == ILK_AXIS_HOMING) && (axis.homed != 0u) && sound_axis(&before, state.mode));
  GOAL(never_enabled_from_fault,
       allowed && (before.state == ILK_AXIS_FAULTED) && (axis.state == ILK_AXIS_ENABLED));
}
