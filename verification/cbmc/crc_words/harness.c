/**
 * @file
 * What the CRCs of requests and configurations are taken over: every word before the CRC, once, in the order
 * of memory. Each step of a CRC can be undone (proof crc32), so a change of any one word changes the CRC.
 *
 * The step is replaced by one that checks which word it is fed, and gives back an arbitrary running CRC.
 */
#include "crc32.c"
#include "proof.h"

static const void* whole;
static uint32_t reads;
static uint32_t steps;
static uint32_t running_crc;
static bool in_order;

/** Stands for `word_at`: any word, if it is the next one. */
uint32_t read_next(const unsigned char bytes[4]) {
  in_order =
      in_order && __CPROVER_same_object(bytes, whole) && (__CPROVER_POINTER_OFFSET(bytes) == (4u * reads));
  reads++;
  return reads;
}

/** Stands for the step, which must get the word that was read and the running CRC. */
uint32_t fed(uint32_t crc, uint32_t word) {
  uint32_t next;
  steps++;
  in_order = in_order && (crc == running_crc) && (word == steps) && (steps == reads);
  running_crc = next;
  return next;
}

static void expect(const void* of) {
  whole = of;
  reads = 0u;
  steps = 0u;
  running_crc = ILK_CRC32_START;
  in_order = true;
}

static void show_request(void) {
  ilk_request_t request;
  expect(&request);
  const uint32_t crc = ilk_request_crc(&request);
  SHOW(in_order && (&request.sequence + steps == &request.crc),
       "P16: the CRC of a request covers each word before it once");
  SHOW(crc == (running_crc ^ 0xffffffffu), "P16: the CRC of a request is that after its last word, inverted");
}

static void show_config(void) {
  ilk_config_t config;
  expect(&config);
  const uint32_t crc = ilk_config_crc(&config);
  SHOW(in_order && ((4u * steps) == __CPROVER_POINTER_OFFSET(&config.crc)) &&
           ((4u * (steps + 1u)) == sizeof(config)),
       "P13: the CRC of a configuration covers each word before it once");
  SHOW(crc == (running_crc ^ 0xffffffffu),
       "P13: the CRC of a configuration is that after its last word, inverted");
  GOAL(goal_any_crc, crc == 0u);
}

void harness(void) {
  show_request();
  show_config();
  GOAL(never_out_of_order, !in_order);
}
