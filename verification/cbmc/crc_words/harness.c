/**
 * @file
 * What the CRCs of requests and configurations are taken over: every word before the CRC, once, in the order
 * of memory. Each step of a CRC can be undone (proof crc32), so a change of any one word changes the CRC.
 *
 * The step is replaced by one that checks which word it is fed, and gives back an arbitrary running CRC.
 */
#include "config.c"
#include "crc32.c"
#include "integrity.c"
#include "proof.h"

#define CONFIG_WORDS ((sizeof(ilk_config_t) / sizeof(uint32_t)) - 1u)
#define REQUEST_WORDS ((sizeof(ilk_request_t) / sizeof(uint32_t)) - 1u)

static const uint32_t* expected_word;
static uint32_t running_crc;
static bool in_order;

uint32_t fed(uint32_t crc, uint32_t word) {
  uint32_t next;
  in_order = in_order && (crc == running_crc) && (word == *expected_word);
  expected_word++;
  running_crc = next;
  return next;
}

static void expect(const void* first_word) {
  expected_word = first_word;
  running_crc = ILK_CRC32_START;
  in_order = true;
}

static void show_request(void) {
  ilk_request_t request;
  expect(&request);
  const uint32_t crc = ilk_request_crc(&request);
  SHOW(in_order && (expected_word == &request.crc),
       "P16: the CRC of a request covers each word before it once");
  SHOW(crc == (running_crc ^ 0xffffffffu), "P16: the CRC of a request is that after its last word, inverted");
}

static void show_config(void) {
  ilk_config_t config;
  expect(&config);
  const uint32_t crc = ilk_config_crc(&config);
  SHOW(in_order && (expected_word == &config.crc),
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
