#include "parts.h"

uint32_t ilk_crc32_words(uint32_t crc, const uint8_t bytes[], uint32_t words) {
  uint32_t next = crc;
  for (uint32_t word = 0u; word < words; word++) {
    next = ilk_crc32_word(next, word_at(&bytes[4u * word]));
  }
  return next;
}

/** Of all words before the last, which holds it. */
static uint32_t crc_before_last(const uint8_t bytes[], uint32_t size_bytes) {
  return ilk_crc32_words(ILK_CRC32_START, bytes, (size_bytes / 4u) - 1u) ^ ILK_CRC32_START;
}

uint32_t ilk_request_crc(const ilk_request_t *request) {
  return crc_before_last((const uint8_t *)request, (uint32_t)sizeof(*request));
}

uint32_t ilk_config_crc(const ilk_config_t *config) {
  return crc_before_last((const uint8_t *)config, (uint32_t)sizeof(*config));
}
