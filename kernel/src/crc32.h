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

/** The running CRC after one more word. */
uint32_t ilk_crc32_word(uint32_t crc, uint32_t word);

/** The CRC as stored and compared. */
uint32_t ilk_crc32_finish(uint32_t crc);

#endif
