/**
 * @file
 * CRC-32: the step of crc32.h, which reads tables, is IEEE 802.3 (reflected) done bit by bit, for every
 * running CRC and every word; and it forgets nothing, so that a change of one word always changes what comes
 * out.
 *
 * A word is the exclusive-or of its four bytes in their places, and the bit step is linear: so each byte is
 * followed by itself through 32 bit steps, and the whole is their exclusive-or, by induction over the steps.
 */
#include "crc32.c"
#include "proof.h"

#define POLYNOMIAL 0xedb88320u

/** One bit, as the standard has it. */
static uint32_t bit_step(uint32_t crc) {
  const uint32_t shifted = crc >> 1;
  return ((crc & 1u) != 0u) ? (shifted ^ POLYNOMIAL) : shifted;
}

/** The one value that `bit_step` leads to `crc`. */
static uint32_t bit_step_back(uint32_t crc) {
  const bool divided = (crc >> 31) != 0u;
  return divided ? (((crc ^ POLYNOMIAL) << 1) | 1u) : (crc << 1);
}

static void show_bytes(void) {
  uint32_t byte;
  uint32_t place;
  GIVEN((byte <= 0xffu) && (place < 4u));
  uint32_t remainder = byte << (8u * place);
  for (uint32_t bit = 0u; bit < 32u; bit++) {
    remainder = bit_step(remainder);
  }
  SHOW(ilk_crc32_table[3u - place][byte] == remainder,
       "P13, P16: each entry of the tables is its byte's remainder");
  GOAL(goal_last_entry, (byte == 0xffu) && (place == 0u));
}

static void show_induction(void) {
  uint32_t whole;
  uint32_t part[4];
  GIVEN(whole == (part[0] ^ part[1] ^ part[2] ^ part[3]));
  SHOW(bit_step(whole) == (bit_step(part[0]) ^ bit_step(part[1]) ^ bit_step(part[2]) ^ bit_step(part[3])),
       "CRC: a bit step of a sum is the sum of the bit steps");
  SHOW(bit_step_back(bit_step(whole)) == whole, "CRC: a bit step can be undone, so it forgets nothing");
}

static void show_word(void) {
  uint32_t crc;
  uint32_t word;
  uint32_t remainder[4];
  const uint32_t start = crc ^ word;
  const uint32_t byte[4] = {start & 0xffu, (start >> 8) & 0xffu, (start >> 16) & 0xffu, start >> 24};
  SHOW(start == (byte[0] ^ (byte[1] << 8) ^ (byte[2] << 16) ^ (byte[3] << 24)), "CRC: the induction starts");
  for (uint32_t place = 0u; place < 4u; place++) {
    GIVEN(remainder[place] == ilk_crc32_table[3u - place][byte[place]]); /* show_bytes */
  }
  SHOW(ilk_crc32_word(crc, word) == (remainder[0] ^ remainder[1] ^ remainder[2] ^ remainder[3]),
       "P13, P16: the word step is 32 bit steps of the running CRC exclusive-or the word");
  GOAL(goal_dense_word, (crc == ILK_CRC32_START) && (word == 0x12345678u));
  GOAL(never_a_word_forgotten, (ilk_crc32_word(crc, word) == 0u) && (start == 1u));
}

static void show_bytes_of_word(void) {
  uint32_t word;
  SHOW(word_at((const unsigned char*)&word) == word, "P13, P14: a word is its bytes, the lowest first");
}

static void show_check_value(void) {
  uint32_t crc = ILK_CRC32_START;
  crc = ilk_crc32_word(crc, 0x34333231u);
  crc = ilk_crc32_word(crc, 0x38373635u);
  SHOW((crc ^ ILK_CRC32_START) == 0x9ae0daafu, "CRC: that of the text 12345678 is the published one");
}

void harness(void) {
  show_bytes();
  show_induction();
  show_word();
  show_bytes_of_word();
  show_check_value();
}
