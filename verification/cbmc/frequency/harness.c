/**
 * @file
 * P7, P16: the frequency word of a HIGH_FREQUENCY card, by spec/frames.md: each point of the published map
 * has its word, a drive between two points lies between their words, and no word is faster than the last. So
 * a bound on drive is a bound on speed. The interpolation between two points, and that more drive is never a
 * slower word there, is shown by the test P16_frames.HIGH_FREQUENCY_more_drive_is_never_a_slower_word.
 */
#include "frame.c"
#include "proof.h"

#define POINTS 24u

/** The word of a point of the published map. */
static uint32_t word_of(uint32_t point) { return 1196612456u - (4063228u * point); }

/** The published map: thousandths of a revolution per minute, the faster of both directions. */
static const uint32_t published_speed[POINTS] = {
    0u,     54u,    189u,   331u,   614u,   1095u,  2020u,   3222u,   3773u,   6383u,   11445u,  15308u,
    20955u, 27358u, 36039u, 45548u, 58997u, 78710u, 105850u, 141386u, 188106u, 247388u, 317394u, 397785u};

static void show_points(void) {
  for (uint32_t point = 1u; point < POINTS; point++) {
    SHOW(frequency_word(published_speed[point]) == word_of(point), "P16: each point of the map has its word");
    SHOW(published_speed[point] > published_speed[point - 1u], "P16: the map rises");
  }
}

static void show_order(void) {
  uint32_t drive;
  uint32_t point;
  GIVEN((drive < UINT32_MAX) && (point > 0u) && (point < POINTS));
  const uint32_t word = frequency_word(drive);
  const uint32_t slower = published_speed[point - 1u];
  const uint32_t faster = published_speed[point];
  SHOW(word >= word_of(POINTS - 1u), "P7: no word is faster than the last");
  SHOW(IMPLIES(drive >= published_speed[POINTS - 1u], word == word_of(POINTS - 1u)),
       "P7: a drive above the last point is packed as the last point");
  if ((drive > slower) && (drive <= faster)) {
    SHOW((word <= word_of(point - 1u)) && (word >= word_of(point)),
         "P16: a drive between two points lies between their words");
  }
  GOAL(goal_between, (drive > slower) && (drive < faster) && (point == 5u));
  GOAL(goal_beyond, drive == 400000u);
  GOAL(never_faster_than_the_last, word < word_of(POINTS - 1u));
}

void harness(void) {
  show_points();
  show_order();
}
