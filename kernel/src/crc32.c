#include "crc32.h"

#include "interlock/kernel.h"

uint32_t ilk_crc32_words(uint32_t crc, const unsigned char bytes[], uint32_t words) {
  uint32_t next = crc;
  for (uint32_t word = 0u; word < words; word++) {
    next = ilk_crc32_word(next, word_at(&bytes[4u * word]));
  }
  return next;
}

uint32_t ilk_crc32_finish(uint32_t crc) { return crc ^ 0xffffffffu; }

uint32_t ilk_request_crc(const ilk_request_t *request) {
  const uint32_t words = (uint32_t)(sizeof(*request) / sizeof(uint32_t)) - 1u;
  return ilk_crc32_finish(ilk_crc32_words(ILK_CRC32_START, (const unsigned char *)request, words));
}

uint32_t ilk_config_crc(const ilk_config_t *config) {
  const uint32_t words = (uint32_t)(sizeof(*config) / sizeof(uint32_t)) - 1u;
  return ilk_crc32_finish(ilk_crc32_words(ILK_CRC32_START, (const unsigned char *)config, words));
}
