/**
 * @file
 * Card frames, spec/frames.md (property P16).
 */
#ifndef ILK_FRAME_H
#define ILK_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/acsl.h"
#include "interlock/types.h"

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

/*@ // Sum of the first words of a frame, modulo 2^32.
  @ logic integer frame_sum(uint32_t *frame, integer words) =
  @   words <= 0 ? 0 : (uint32_t)(frame_sum(frame, words - 1) + frame[words - 1]);
  @
  @ // P16: start word and checksum are right.
  @ predicate whole(uint32_t *frame) =
  @   frame[0] == 0xfefefe01 && frame_sum(frame, ILK_FRAME_WORDS) == 0xffffffff;
  @
  @ predicate rests(ilk_command_t *command) = command->direction == ILK_DIRECTION_NONE || command->drive == 0;
  @
  @ // The published direction bit of a motor that follows the axis, or does not.
  @ logic boolean motor_decreases(ilk_axis_config_t *config, integer direction) =
  @   (config->motor_direction != 0) == (direction == ILK_DIRECTION_DECREASING);
  @
  @ // Points of the published map of a high-frequency motor (spec/frames.md): the first one not slower, ...
  @ logic integer map_point(integer drive) =
  @   drive <= 54       ? 1
  @   : drive <= 189    ? 2
  @   : drive <= 331    ? 3
  @   : drive <= 614    ? 4
  @   : drive <= 1095   ? 5
  @   : drive <= 2020   ? 6
  @   : drive <= 3222   ? 7
  @   : drive <= 3773   ? 8
  @   : drive <= 6383   ? 9
  @   : drive <= 11445  ? 10
  @   : drive <= 15308  ? 11
  @   : drive <= 20955  ? 12
  @   : drive <= 27358  ? 13
  @   : drive <= 36039  ? 14
  @   : drive <= 45548  ? 15
  @   : drive <= 58997  ? 16
  @   : drive <= 78710  ? 17
  @   : drive <= 105850 ? 18
  @   : drive <= 141386 ? 19
  @   : drive <= 188106 ? 20
  @   : drive <= 247388 ? 21
  @   : drive <= 317394 ? 22
  @                     : 23;
  @
  @ // ... and the speed at a point.
  @ logic integer map_speed(integer point) =
  @   point <= 0    ? 0
  @   : point == 1  ? 54
  @   : point == 2  ? 189
  @   : point == 3  ? 331
  @   : point == 4  ? 614
  @   : point == 5  ? 1095
  @   : point == 6  ? 2020
  @   : point == 7  ? 3222
  @   : point == 8  ? 3773
  @   : point == 9  ? 6383
  @   : point == 10 ? 11445
  @   : point == 11 ? 15308
  @   : point == 12 ? 20955
  @   : point == 13 ? 27358
  @   : point == 14 ? 36039
  @   : point == 15 ? 45548
  @   : point == 16 ? 58997
  @   : point == 17 ? 78710
  @   : point == 18 ? 105850
  @   : point == 19 ? 141386
  @   : point == 20 ? 188106
  @   : point == 21 ? 247388
  @   : point == 22 ? 317394
  @                 : 397785;
  @
  @ // Between two points in proportion, rounded to the slower side; the last point for anything faster.
  @ logic integer map_word(integer drive) = 1196612456 - (map_point(drive) - 1) * 4063228
  @   - ((\min(drive, 397785) - map_speed(map_point(drive) - 1)) * 4063228)
  @       / (map_speed(map_point(drive)) - map_speed(map_point(drive) - 1));
  @
  @ // The words of an outgoing frame that make a motor move.
  @ logic integer wave1_word(ilk_axis_config_t *config, ilk_command_t *command) =
  @   config->card == ILK_CARD_HIGH_FREQUENCY
  @     ? ((motor_decreases(config, command->direction) ? 0 : 0x01000000) | command->amplitude)
  @     : 0;
  @
  @ logic integer wave2_word(ilk_axis_config_t *config, ilk_command_t *command) =
  @   config->card == ILK_CARD_HIGH_FREQUENCY
  @     ? ((motor_decreases(config, command->direction) ? 0x01000000 : 0) | command->amplitude)
  @     : 0;
  @
  @ logic integer frequency1_word(ilk_axis_config_t *config, ilk_command_t *command) =
  @   config->card == ILK_CARD_PWM
  @     ? ((motor_decreases(config, command->direction) ? 0 : 0x80000000) | command->drive)
  @   : config->card == ILK_CARD_NON_PWM
  @     ? ((motor_decreases(config, command->direction) ? 0x40000000 : 0xc0000000) | command->drive)
  @   : config->card == ILK_CARD_HIGH_FREQUENCY ? map_word(command->drive)
  @                                             : 0;
  @
  @ logic integer frequency2_word(ilk_axis_config_t *config, ilk_command_t *command) =
  @   config->card == ILK_CARD_HIGH_FREQUENCY ? map_word(command->drive) : 0;
  @
  @ logic integer analog_word(ilk_axis_config_t *config, ilk_command_t *command) =
  @   config->card == ILK_CARD_ANALOG
  @     ? ((motor_decreases(config, command->direction) ? 0 : 0x80000000) | command->drive)
  @     : 0;
  @*/

/** Reads an incoming frame. */
/*@ requires readable: \valid_read(frame + (0 .. ILK_FRAME_WORDS - 1));
  @ assigns  \nothing;
  @ ensures  P16_intact: \result.intact <==> whole(frame);
  @ ensures  P16_switch: \result.switch_triggered <==> (frame[2] & 0x00080000) == 0;
  @ ensures  P16_words: \result.raw == frame[3] && \result.heartbeat == frame[9]
  @   && \result.card_time_us == frame[10] && \result.tick_echo == frame[11] && \result.card_status == frame[12];
  @*/
ilk_reading_t ilk_frame_unpack(const uint32_t frame[ILK_FRAME_WORDS]);

/** Writes all words of an outgoing frame. A command with no direction or no drive is packed as zero drive. */
/*@ requires readable: \valid_read(config) && \valid_read(command);
  @ requires writable: \valid(frame + (0 .. ILK_FRAME_WORDS - 1));
  @ requires apart: \separated(config, command, frame + (0 .. ILK_FRAME_WORDS - 1));
  @ assigns  frame[0 .. ILK_FRAME_WORDS - 1];
  @ ensures  P16_whole: whole(frame);
  @ ensures  P16_zero_drive: \old(rests(command) || !carries_axis(config)) ==> still_frame(frame);
  @ ensures  P16_waves: \old(!rests(command)) ==>
  @   frame[2] == \old(wave1_word(config, command)) && frame[4] == \old(wave2_word(config, command));
  @ ensures  P16_frequencies: \old(!rests(command)) ==>
  @   frame[3] == \old(frequency1_word(config, command)) && frame[5] == \old(frequency2_word(config, command));
  @ ensures  P16_analog: \old(!rests(command)) ==> frame[6] == \old(analog_word(config, command));
  @ ensures  P16_amplifier: \old(!rests(command) && carries_axis(config)) ==> frame[14] == 1;
  @ ensures  P16_tick: frame[13] == tick;
  @ ensures  P16_unnamed: frame[1] == 0 && (\forall integer word; 7 <= word <= 12 ==> frame[word] == 0)
  @   && (\forall integer word; 15 <= word < ILK_FRAME_WORDS - 1 ==> frame[word] == 0);
  @*/
void ilk_frame_pack(const ilk_axis_config_t *config, const ilk_command_t *command, uint32_t tick,
                    uint32_t frame[ILK_FRAME_WORDS]);

#endif
