#include "crc32.h"

#include "interlock/kernel.h"

uint32_t ilk_crc32_finish(uint32_t crc) { return crc ^ 0xffffffffu; }

/*@ ensures exact: \result == (0xffffffff ^
  @   crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(
  @     ILK_CRC32_START, request->sequence), request->kind), request->axis), (uint32_t)request->target_counts),
  @     request->drive), request->amplitude), request->lease_ticks), request->holder));
  @*/
uint32_t ilk_request_crc(const ilk_request_t *request) {
  uint32_t crc = ILK_CRC32_START;
  crc = ilk_crc32_word(crc, request->sequence);
  crc = ilk_crc32_word(crc, request->kind);
  crc = ilk_crc32_word(crc, request->axis);
  crc = ilk_crc32_word(crc, (uint32_t)request->target_counts);
  crc = ilk_crc32_word(crc, request->drive);
  crc = ilk_crc32_word(crc, request->amplitude);
  crc = ilk_crc32_word(crc, request->lease_ticks);
  crc = ilk_crc32_word(crc, request->holder);
  return ilk_crc32_finish(crc);
}
