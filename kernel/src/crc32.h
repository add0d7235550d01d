/**
 * @file
 * CRC-32 (IEEE 802.3, reflected) of structures of 32-bit words, each least significant byte first.
 */
#ifndef ILK_CRC32_H
#define ILK_CRC32_H

#include <stdint.h>

#define ILK_CRC32_START 0xffffffffu

/** Remainders of each byte followed by n zero bytes, n the row. */
extern const uint32_t ilk_crc32_table[4][256];

/** The word at these four bytes, as the machines that this runs on store it: lowest byte first. */
static inline uint32_t word_at(const unsigned char bytes[4]) {
  return (uint32_t)bytes[0] | ((uint32_t)bytes[1] << 8u) | ((uint32_t)bytes[2] << 16u) |
         ((uint32_t)bytes[3] << 24u);
}

/** The running CRC after one more word. */
static inline uint32_t ilk_crc32_word(uint32_t crc, uint32_t word) {
  const uint32_t mixed = crc ^ word;
  return ilk_crc32_table[3][mixed & 0xffu] ^ ilk_crc32_table[2][(mixed >> 8) & 0xffu] ^
         ilk_crc32_table[1][(mixed >> 16) & 0xffu] ^ ilk_crc32_table[0][mixed >> 24];
}

/** The running CRC after `words` more words. Start with ILK_CRC32_START, finish with `ilk_crc32_finish`. */
uint32_t ilk_crc32_words(uint32_t crc, const unsigned char bytes[], uint32_t words);

/** The CRC as stored and compared. */
uint32_t ilk_crc32_finish(uint32_t crc);

#endif
