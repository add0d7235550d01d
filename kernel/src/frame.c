#include "parts.h"

_Static_assert((ILK_FRAME_WORDS == 32) || (ILK_FRAME_WORDS == 64), "frames have 32 or 64 words");

#define CHECKSUM_WORD (ILK_FRAME_WORDS - 1)
#define START_WORD 0xfefefe01u
#define FRAME_SUM 0xffffffffu
#define SWITCH_OPEN_BIT 0x00080000u
#define PWM_REVERSED 0x80000000u
#define WAVE_REVERSED 0x01000000u
#define NON_PWM_FORWARD 0x40000000u
#define NON_PWM_REVERSED 0xc0000000u

#define FREQUENCY_OF_REST 1196612456u
#define FREQUENCY_STEP 4063228u
#define SPEED_POINTS 24u

/** Sum of all words; the checksum makes it FRAME_SUM. */
static uint32_t sum_of(const uint32_t frame[ILK_FRAME_WORDS]) {
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word < (uint32_t)ILK_FRAME_WORDS; word++) {
    sum += frame[word];
  }
  return sum;
}

ilk_reading_t ilk_frame_unpack(const uint32_t frame[ILK_FRAME_WORDS]) {
  return (ilk_reading_t){
      .intact = (frame[0] == START_WORD) && (sum_of(frame) == FRAME_SUM),
      .switch_triggered = (frame[2] & SWITCH_OPEN_BIT) == 0u,
      .raw = frame[3],
      .heartbeat = frame[9],
      .card_time_us = frame[10],
      .tick_echo = frame[11],
      .card_status = frame[12],
  };
}

/** Frequency word of a high-frequency card for a drive in thousandths of a revolution per minute. */
static uint32_t frequency_word(uint32_t drive) {
  /* Speed at each point of the published map, the faster of both directions, in thousandths of a revolution
     per minute: kinematics of the published high-frequency motor, spec/frames.md. */
  static const uint32_t speed_map[SPEED_POINTS] = {
      0u,     54u,    189u,   331u,   614u,   1095u,  2020u,   3222u,   3773u,   6383u,   11445u,  15308u,
      20955u, 27358u, 36039u, 45548u, 58997u, 78710u, 105850u, 141386u, 188106u, 247388u, 317394u, 397785u};
  uint32_t point = 1u;
  while ((point < (SPEED_POINTS - 1u)) && (speed_map[point] < drive)) {
    point++;
  }
  const uint32_t slower = speed_map[point - 1u];
  const uint32_t faster = speed_map[point];
  const uint32_t reached = (drive < faster) ? drive : faster;
  const uint64_t above = (uint64_t)reached - slower;
  const uint64_t width = (uint64_t)faster - slower;
  /* Rounding the descent down rounds the word up, to the slower side. */
  const uint64_t descent = (above * FREQUENCY_STEP) / width;
  return FREQUENCY_OF_REST - ((point - 1u) * FREQUENCY_STEP) - (uint32_t)descent;
}

/** The words of an outgoing frame that make a motor move: waves and frequencies 2 to 5, analog 6,
 * amplifier 14. */
static void pack_drive(const ilk_axis_config_t *config, const ilk_command_t *command,
                       uint32_t frame[ILK_FRAME_WORDS]) {
  /* The published `actualDirection`: decreasing positions when the motor follows the axis. */
  const bool decreases =
      (command->direction == (uint32_t)ILK_DIRECTION_DECREASING) == (config->motor_direction != 0u);
  frame[14] = 1u;
  switch (config->card) {
    case (uint32_t)ILK_CARD_PWM:
      frame[3] = (decreases ? 0u : PWM_REVERSED) | command->drive;
      break;
    case (uint32_t)ILK_CARD_NON_PWM:
      frame[3] = (decreases ? NON_PWM_FORWARD : NON_PWM_REVERSED) | command->drive;
      break;
    case (uint32_t)ILK_CARD_ANALOG:
      frame[6] = (decreases ? 0u : PWM_REVERSED) | command->drive;
      break;
    case (uint32_t)ILK_CARD_HIGH_FREQUENCY:
      frame[2] = (decreases ? 0u : WAVE_REVERSED) | command->amplitude;
      frame[4] = (decreases ? WAVE_REVERSED : 0u) | command->amplitude;
      frame[3] = frequency_word(command->drive);
      frame[5] = frame[3];
      break;
    default:
      frame[14] = 0u; /* No motor. */
      break;
  }
}

void ilk_frame_pack(const ilk_axis_config_t *config, const ilk_command_t *command, uint32_t tick,
                    uint32_t frame[ILK_FRAME_WORDS]) {
  for (uint32_t word = 0u; word < (uint32_t)ILK_FRAME_WORDS; word++) {
    frame[word] = 0u;
  }
  if ((command->direction != (uint32_t)ILK_DIRECTION_NONE) && (command->drive != 0u)) {
    pack_drive(config, command, frame);
  }
  frame[0] = START_WORD;
  frame[13] = tick;
  frame[CHECKSUM_WORD] =
      FRAME_SUM - (START_WORD + frame[2] + frame[3] + frame[4] + frame[5] + frame[6] + tick + frame[14]);
}
