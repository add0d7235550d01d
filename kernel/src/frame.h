/**
 * @file
 * Card frames, spec/frames.md (property P16).
 */
#ifndef ILK_FRAME_H
#define ILK_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

/** Bit of `card_status`: the card was reset since it started. */
#define ILK_STATUS_WAS_RESET 8u

/** What one incoming frame says. Meaningless unless `intact`. */
typedef struct {
  bool intact; /**< start word and checksum are right */
  bool switch_triggered;
  uint32_t raw;
  uint32_t heartbeat;
  uint32_t card_time_us;
  uint32_t tick_echo;
  uint32_t card_status;
} ilk_reading_t;

/** Reads an incoming frame. */
ilk_reading_t ilk_frame_unpack(const uint32_t frame[ILK_FRAME_WORDS]);

/** Writes all words of an outgoing frame. A command with no direction or no drive is packed as zero drive. */
void ilk_frame_pack(const ilk_axis_config_t *config, const ilk_command_t *command, uint32_t tick,
                    uint32_t frame[ILK_FRAME_WORDS]);

#endif
