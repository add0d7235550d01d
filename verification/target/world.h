/**
 * @file
 * A small deterministic world around the kernel, the same on every machine: cards with ideal motors, a hand
 * on the pedal, an app, and now and then a fault. Integers only; every choice comes from one seed.
 */
#ifndef ILK_TARGET_WORLD_H
#define ILK_TARGET_WORLD_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/kernel.h"

/** A source of choices (xorshift). `word` is never zero. */
typedef struct {
  uint32_t word;
} dice_t;

uint32_t dice_word(dice_t *dice);
uint32_t dice_below(dice_t *dice, uint32_t bound);
bool dice_one_in(dice_t *dice, uint32_t chances);

/** What the trace remembers of the world between two ticks. */
typedef struct {
  dice_t dice;
  uint32_t sequence;
  uint32_t heartbeat;
  uint32_t silent_ticks; /**< the app says nothing for so long */
  uint32_t pedal_ticks;  /**< the hand stays as it is for so long */
  uint32_t estop_ticks;  /**< the E-stop stays active for so long */
  uint32_t loose_ticks;  /**< a contact of the pedal reads wrong for so long */
  uint32_t late_ticks;   /**< deadlines are missed for so long */
  uint32_t deaf_ticks;   /**< `deaf_slots` do not answer for so long */
  uint32_t deaf_slots;
  bool pressed;
  int32_t place[ILK_SLOTS];           /**< of the motor, in the sense of the position */
  uint32_t jammed_ticks[ILK_SLOTS];   /**< the motor does not follow its drive for so long */
  uint32_t slipping_ticks[ILK_SLOTS]; /**< the axis slips downwards for so long */
  uint32_t misread_ticks[ILK_SLOTS];  /**< the switch reads the other way for so long */
  uint32_t reset_ticks[ILK_SLOTS];    /**< the card says for so long that it was reset */
} world_t;

/** A valid configuration: eight axes of every kind of card and switch, a required sensor, an empty slot. */
void world_config(ilk_config_t *config);

void world_begin(world_t *world, uint32_t seed);

/** The inputs of the next tick, after the motors have followed `out`. */
void world_inputs(world_t *world, const ilk_config_t *config, const ilk_state_t *state,
                  const ilk_outputs_t *out, ilk_inputs_t *in);

/** The requests of the next tick: what the mode suggests, now and then nonsense. Returns how many. */
uint32_t world_requests(world_t *world, const ilk_config_t *config, const ilk_state_t *state,
                        ilk_request_t requests[ILK_REQUESTS_PER_TICK]);

/** A state that passes the kernel's own check, reachable or not; now and then with one bit of it flipped.
 * True when it passes. */
bool world_any_state(dice_t *dice, const ilk_config_t *config, ilk_state_t *state);

#endif
