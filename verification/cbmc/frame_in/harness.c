/**
 * @file
 * P16: incoming frames, by spec/frames.md. A frame with a wrong start word or checksum is never used, and
 * each word is read from its place. The frame is arbitrary bits.
 */
#include "frame.c"
#include "proof.h"

#define LAST (ILK_FRAME_WORDS - 1)

static uint32_t plus(uint32_t a, uint32_t b) { return a + b; }

static uint32_t sum_with_last(const uint32_t frame[ILK_FRAME_WORDS]) {
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word <= (uint32_t)LAST; word++) {
    sum = plus(sum, frame[word]);
  }
  return sum;
}

/** The last word is the complement of the sum of the others exactly when all of them sum up to 0xffffffff. */
static void show_complement(uint32_t others, uint32_t last) {
  SHOW((last == (0xffffffffu - others)) == (plus(others, last) == 0xffffffffu),
       "P16: the checksum is the complement of the sum of the words before it");
}

void harness(void) {
  uint32_t others;
  uint32_t last;
  uint32_t frame[ILK_FRAME_WORDS];
  show_complement(others, last);
  const ilk_reading_t reading = ilk_frame_unpack(frame);
  SHOW(reading.intact == ((frame[0] == 0xfefefe01u) && (sum_with_last(frame) == 0xffffffffu)),
       "P16: intact exactly when start word and checksum are right");
  SHOW(reading.switch_triggered == (((frame[2] >> 19) & 1u) == 0u),
       "P3: bit 3 of the state is 0 when triggered");
  SHOW((reading.raw == frame[3]) && (reading.heartbeat == frame[9]) && (reading.card_time_us == frame[10]) &&
           (reading.tick_echo == frame[11]) && (reading.card_status == frame[12]),
       "P16: each word is read from its place");
  GOAL(goal_intact, reading.intact && (frame[LAST] == 0u));
  GOAL(goal_wrong_sum, !reading.intact && (frame[0] == 0xfefefe01u));
  GOAL(never_intact_with_wrong_start, reading.intact && (frame[0] != 0xfefefe01u));
}
