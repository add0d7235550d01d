#include "layout_table.h"

static uint32_t crc_word(uint32_t crc, uint32_t word) {
  uint32_t next = crc ^ word;
  for (unsigned bit = 0; bit < 32u; ++bit) {
    next = (next >> 1) ^ (((next & 1u) != 0u) ? 0xEDB88320u : 0u);
  }
  return next;
}

uint32_t ilk_layout_crc(const ilk_layout_field_t fields[], size_t count) {
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = 0; i < count; ++i) {
    crc = crc_word(crc, fields[i].struct_bytes);
    crc = crc_word(crc, fields[i].offset);
    crc = crc_word(crc, fields[i].bytes);
  }
  return ~crc;
}

uint32_t ilk_link_layout_hash(void) {
  static const ilk_layout_field_t fields[] = {ILK_LAYOUT_FIELDS(ILK_LAYOUT_ENTRY)};
  return ilk_layout_crc(fields, sizeof fields / sizeof fields[0]);
}
