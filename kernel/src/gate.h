/**
 * @file
 * From wish to drive: what each axis wants, and the output gate that alone lets it through
 * (properties P1, P2, P3, P4, P7).
 */
#ifndef ILK_GATE_H
#define ILK_GATE_H

#include "interlock/types.h"

/** What the axis' move or homing asks for, before any gate. */
ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/**
 * The output gate: a pure function of configuration, state and wish. OPEN alone lets the wish through.
 *
 * @return the first gate that blocks.
 */
ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_state_t *state, const ilk_axis_t *axis,
                           const ilk_command_t *wanted);

#endif
