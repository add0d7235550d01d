/**
 * @file
 * P16: outgoing frames, by spec/frames.md. What is packed is exactly what the tables say, and says the same
 * command when it is read back; zero drive makes all drive words zero. Configuration and command are
 * arbitrary bits.
 */
#include "frame.c"
#include "proof.h"

#define LAST (ILK_FRAME_WORDS - 1)

static uint32_t frequency_asked_for;
static uint32_t frequency_given;

uint32_t some_word(uint32_t drive) {
  uint32_t word;
  frequency_asked_for = drive;
  frequency_given = word;
  return word;
}

static uint32_t sum_before_last(const uint32_t frame[ILK_FRAME_WORDS]) {
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word < (uint32_t)LAST; word++) {
    sum += frame[word];
  }
  return sum;
}

static bool carries_drive(const uint32_t frame[ILK_FRAME_WORDS]) {
  return (frame[2] | frame[3] | frame[4] | frame[5] | frame[6] | frame[14]) != 0u;
}

/** The published direction bit: `actual` of spec/frames.md. */
static bool actual_direction(const ilk_axis_config_t* config, const ilk_command_t* command) {
  const bool set_direction = command->direction == ILK_DIRECTION_DECREASING;
  return (config->motor_direction != 0u) == set_direction;
}

/** The drive words of each card, read from the tables of spec/frames.md. */
static void show_driven(const ilk_axis_config_t* config, const ilk_command_t* command,
                        const uint32_t frame[ILK_FRAME_WORDS]) {
  const bool actual = actual_direction(config, command);
  const bool waves = config->card == ILK_CARD_HIGH_FREQUENCY;
  const bool motor = (config->card >= ILK_CARD_PWM) && (config->card <= ILK_CARD_HIGH_FREQUENCY);
  SHOW(frame[14] == (motor ? 1u : 0u), "P16: the amplifier of a driven card is on");
  if (config->card == ILK_CARD_PWM) {
    SHOW(((frame[3] & 0x7fffffffu) == command->drive) && ((frame[3] >> 31) == (actual ? 0u : 1u)),
         "P16: PWM reads back as the same speed and direction");
  }
  if (config->card == ILK_CARD_NON_PWM) {
    SHOW(((frame[3] & 0x3fffffffu) == command->drive) && ((frame[3] >> 30) == (actual ? 1u : 3u)),
         "P16: NON_PWM reads back as the same speed, direction and enable bit");
  }
  if (config->card == ILK_CARD_ANALOG) {
    SHOW(((frame[6] & 0x7fffffffu) == command->drive) && ((frame[6] >> 31) == (actual ? 0u : 1u)),
         "P16: ANALOG reads back as the same level and direction");
  }
  if (waves) {
    SHOW(((frame[2] & 0xffu) == command->amplitude) && ((frame[4] & 0xffu) == command->amplitude),
         "P16: both waves carry the amplitude");
    SHOW(((frame[2] >> 8) == (actual ? 0u : 0x10000u)) && ((frame[4] >> 8) == (actual ? 0x10000u : 0u)),
         "P16: the waves' tables carry the direction");
    SHOW((frequency_asked_for == command->drive) && (frame[3] == frequency_given) &&
             (frame[5] == frequency_given),
         "P16: both waves have the frequency of the drive");
  }
  SHOW(waves || ((frame[2] | frame[4] | frame[5]) == 0u), "P16: only a HIGH_FREQUENCY card has waves");
  SHOW((config->card == ILK_CARD_ANALOG) || (frame[6] == 0u), "P16: only an ANALOG card has a level");
  SHOW(motor || !carries_drive(frame), "P1: a card without a motor is sent zero drive");
}

/** The gate lets nothing else through (proof gate, P7). */
static bool fits_the_card(const ilk_axis_config_t* config, const ilk_command_t* command) {
  const uint32_t largest = (config->card == ILK_CARD_NON_PWM) ? 0x3fffffffu : 0x7fffffffu;
  return (command->direction < ILK_DIRECTION_COUNT) && (command->drive <= largest) &&
         (command->amplitude <= 0xffu);
}

void harness(void) {
  ilk_axis_config_t config;
  ilk_command_t command;
  uint32_t tick;
  uint32_t frame[ILK_FRAME_WORDS];
  ilk_frame_pack(&config, &command, tick, frame);
  const bool zero = (command.direction == ILK_DIRECTION_NONE) || (command.drive == 0u);
  SHOW((frame[0] == 0xfefefe01u) && (frame[13] == tick),
       "P16: start word and tick counter are in their places");
  SHOW((frame[1] | frame[7] | frame[8] | frame[9] | frame[10] | frame[11] | frame[12]) == 0u,
       "P16: words that no table names are zero");
  for (uint32_t word = 15u; word < (uint32_t)LAST; word++) {
    SHOW(frame[word] == 0u, "P16: words that no table names are zero");
  }
  SHOW(IMPLIES(zero, !carries_drive(frame)), "P2: zero drive is zero in every drive word");
  if (!zero && fits_the_card(&config, &command)) {
    show_driven(&config, &command, frame);
  }
  SHOW(frame[LAST] == (0xffffffffu - sum_before_last(frame)),
       "P16: the checksum is that of the words before it");
  GOAL(goal_zero_drive, zero && (command.amplitude != 0u));
  GOAL(goal_pwm, !zero && (config.card == ILK_CARD_PWM) && (command.drive == 0x7fffffffu));
  GOAL(goal_non_pwm, !zero && (config.card == ILK_CARD_NON_PWM) && (frame[3] == 0xc0000001u));
  GOAL(goal_analog, !zero && (config.card == ILK_CARD_ANALOG) && (frame[6] == 1u));
  GOAL(goal_waves, !zero && (config.card == ILK_CARD_HIGH_FREQUENCY) && (frame[2] == 0x010000ffu));
  GOAL(never_without_motor, (config.card == ILK_CARD_SENSOR) && carries_drive(frame));
}
