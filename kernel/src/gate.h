/**
 * @file
 * From wish to drive: what each axis wants, and the output gate that alone lets it through
 * (properties P1, P2, P3, P4, P7).
 */
#ifndef ILK_GATE_H
#define ILK_GATE_H

#include "interlock/acsl.h"
#include "interlock/types.h"

/** What the axis' move or homing asks for, before any gate. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  move: axis->state == ILK_AXIS_MOVING ==>
  @   \result.direction == setpoint_direction(config, axis)
  @   && \result.drive == axis->drive && \result.amplitude == axis->amplitude;
  @ ensures  homing: axis->state == ILK_AXIS_HOMING ==>
  @   \result.direction == homing_direction(config, axis)
  @   && \result.drive == config->home_drive && \result.amplitude == config->home_amplitude;
  @ ensures  P12_no_leap: axis->state != ILK_AXIS_MOVING && axis->state != ILK_AXIS_HOMING ==>
  @   \result.direction == ILK_DIRECTION_NONE && \result.drive == 0 && \result.amplitude == 0;
  @*/
ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/**
 * The output gate: a pure function of configuration, state and wish. OPEN alone lets the wish through.
 *
 * @return the first gate that blocks.
 */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(axis) && \valid_read(wanted);
  @ assigns  \nothing;
  @ ensures  P1_gate: \result == ILK_GATE_OPEN ==> may_drive(state, axis);
  @ ensures  P3_hard_limit: \result == ILK_GATE_OPEN ==> clear_of_switch(config, axis, wanted->direction);
  @ ensures  P4_soft_limit: \result == ILK_GATE_OPEN ==> within_soft_range(config, axis, wanted->direction);
  @ ensures  P7_travel: \result == ILK_GATE_OPEN ==> within_unhomed_travel(config, axis, wanted->direction);
  @ ensures  P7_drive: \result == ILK_GATE_OPEN ==> within_drive(config, axis, wanted);
  @ ensures  open: \result == ILK_GATE_OPEN <==>
  @   may_drive(state, axis) && asks_for_motion(wanted) && within_limits(config, axis, wanted);
  @ ensures  P2_mode: \result == ILK_GATE_MODE <==> state->mode != ILK_MODE_MOTION;
  @ ensures  P2_pedal: \result == ILK_GATE_PEDAL <==>
  @   state->mode == ILK_MODE_MOTION && state->pedal != ILK_PEDAL_PRESSED;
  @ ensures  P2_estop: \result == ILK_GATE_ESTOP <==>
  @   state->mode == ILK_MODE_MOTION && state->pedal == ILK_PEDAL_PRESSED && state->estop != 0;
  @ ensures  card: \result == ILK_GATE_CARD <==> consented(state) && axis->card_valid == 0;
  @ ensures  enable: \result == ILK_GATE_ENABLE <==>
  @   consented(state) && axis->card_valid != 0 && !in_service(axis);
  @ ensures  lease: \result == ILK_GATE_LEASE <==>
  @   consented(state) && axis->card_valid != 0 && in_service(axis) && !held(axis);
  @ ensures  setpoint: \result == ILK_GATE_SETPOINT <==> may_drive(state, axis) && !asks_for_motion(wanted);
  @ ensures  hard_limit: \result == ILK_GATE_HARD_LIMIT <==> may_drive(state, axis) && asks_for_motion(wanted)
  @   && !clear_of_switch(config, axis, wanted->direction);
  @ ensures  soft_limit: \result == ILK_GATE_SOFT_LIMIT <==> may_drive(state, axis) && asks_for_motion(wanted)
  @   && clear_of_switch(config, axis, wanted->direction) && !within_soft_range(config, axis, wanted->direction);
  @ ensures  travel: \result == ILK_GATE_UNHOMED_TRAVEL <==> may_drive(state, axis) && asks_for_motion(wanted)
  @   && clear_of_switch(config, axis, wanted->direction) && within_soft_range(config, axis, wanted->direction)
  @   && !within_unhomed_travel(config, axis, wanted->direction);
  @ ensures  known: 0 <= \result < ILK_GATE_COUNT;
  @*/
ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_state_t *state, const ilk_axis_t *axis,
                           const ilk_command_t *wanted);

#endif
