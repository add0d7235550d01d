/**
 * @file
 * CRC-32 (IEEE 802.3, reflected), one 32-bit word at a time, least significant byte first.
 *
 * Start with ILK_CRC32_START, feed words, finish with `ilk_crc32_finish`.
 */
#ifndef ILK_CRC32_H
#define ILK_CRC32_H

#include <stdint.h>

#define ILK_CRC32_START 0xffffffffu

/** Remainders of each byte followed by n zero bytes, n the row. */
extern const uint32_t ilk_crc32_table[4][256];

/*@ // What one more word makes of the running CRC; that the table is that of CRC-32, tests and CBMC show.
  @ logic integer crc_step(integer running, integer next) = \let mixed = (uint32_t)(running ^ next);
  @   (uint32_t)((uint32_t)((uint32_t)(
  @       ilk_crc32_table[3][mixed & 0xff] ^ ilk_crc32_table[2][(mixed >> 8) & 0xff])
  @     ^ ilk_crc32_table[1][(mixed >> 16) & 0xff]) ^ ilk_crc32_table[0][mixed >> 24]);
  @*/

/** The running CRC after one more word. */
/*@ assigns \nothing;
  @ ensures exact: \result == crc_step(crc, word);
  @*/
static inline uint32_t ilk_crc32_word(uint32_t crc, uint32_t word) {
  const uint32_t mixed = crc ^ word;
  return ilk_crc32_table[3][mixed & 0xffu] ^ ilk_crc32_table[2][(mixed >> 8) & 0xffu] ^
         ilk_crc32_table[1][(mixed >> 16) & 0xffu] ^ ilk_crc32_table[0][mixed >> 24];
}

/** The CRC as stored and compared. */
/*@ assigns \nothing;
  @ ensures exact: \result == (crc ^ 0xffffffff);
  @*/
uint32_t ilk_crc32_finish(uint32_t crc);

#endif
