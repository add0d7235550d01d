#include "request.h"

#include "arith.h"
#include "axis.h"
#include "homing.h"
#include "mode.h"

static void apply_heartbeat(ilk_state_t *state, uint32_t holder) {
  state->app_age_ticks = 0u;
  if (state->holder != holder) {
    state->holder = holder;
    ilk_pedal_disarm(state);
    if (state->mode == (uint32_t)ILK_MODE_MOTION) {
      ilk_mode_enter(state, ILK_MODE_READY);
    }
  }
}

static void apply_stop(ilk_state_t *state) {
  if (state->mode == (uint32_t)ILK_MODE_MOTION) {
    ilk_mode_enter(state, ILK_MODE_READY);
  }
}

static void apply_reset(ilk_state_t *state) {
  state->cause = (uint32_t)ILK_CAUSE_NONE;
  state->cause_tick = 0u;
  state->cause_value = 0u;
  state->causes_seen = 0u;
  ilk_mode_enter(state, ILK_MODE_READY);
}

static void apply_enable(ilk_axis_t *axis) {
  if (axis->state == (uint32_t)ILK_AXIS_DISABLED) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
  }
}

/** The stall count starts anew only after a stall: no other fault excuses an axis that makes no progress. */
static void apply_clear_fault(ilk_axis_t *axis) {
  if (axis->fault == (uint32_t)ILK_FAULT_STALL) {
    axis->stall_driven_ticks = 0u;
    axis->setpoint_changed = 0u;
  }
  axis->state = (uint32_t)ILK_AXIS_DISABLED;
  axis->fault = (uint32_t)ILK_FAULT_NONE;
  axis->fault_tick = 0u;
  axis->fault_value = 0;
}

static void apply_move(ilk_axis_t *axis, const ilk_request_t *request) {
  if ((axis->setpoint_counts != request->target_counts) && (axis->stall_driven_ticks != 0u)) {
    axis->setpoint_changed = 1u;
  }
  axis->state = (uint32_t)ILK_AXIS_MOVING;
  axis->setpoint_counts = request->target_counts;
  axis->drive = request->drive;
  axis->amplitude = request->amplitude;
  axis->lease_ticks = request->lease_ticks;
}

static void apply_to_axis(const ilk_axis_config_t *config, ilk_axis_t *axis, const ilk_request_t *request) {
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_DISABLE:
      ilk_axis_disable(axis);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      apply_enable(axis);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      apply_clear_fault(axis);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      apply_move(axis, request);
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      ilk_homing_begin(config, axis);
      break;
    case (uint32_t)ILK_REQUEST_SET_HOME:
      axis->position_counts = 0;
      axis->homed = 1u;
      break;
    case (uint32_t)ILK_REQUEST_RESTORE:
      axis->position_counts = request->target_counts;
      axis->homed = 0u;
      break;
    default:
      /* Every request that names an axis is above. */
      break;
  }
}

void ilk_request_apply(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request) {
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_HEARTBEAT:
      apply_heartbeat(state, request->holder);
      break;
    case (uint32_t)ILK_REQUEST_STOP:
      apply_stop(state);
      break;
    case (uint32_t)ILK_REQUEST_RESET:
      apply_reset(state);
      break;
    default:
      if (request->axis < (uint32_t)ILK_SLOTS) {
        apply_to_axis(&config->axis[request->axis], &state->axis[request->axis], request);
      }
      break;
  }
}
