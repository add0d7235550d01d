#include "interlock/recording_file.h"

#include <stddef.h>
#include <string.h>

#define CRC_WORDS(type, field) ((uint32_t)(offsetof(type, field) / sizeof(uint32_t)))

static bool is_zero(const void *bytes, size_t count) {
  const unsigned char *byte = bytes;
  while (count > 0u && byte[count - 1u] == 0u) {
    --count;
  }
  return count == 0u;
}

/** Whether nothing but zeros comes: blocks of the disk that were promised to the file, but never written. */
static bool rest_is_zero(FILE *file) {
  unsigned char bytes[4096];
  for (;;) {
    const size_t count = fread(bytes, 1u, sizeof bytes, file);
    if (count == 0u || !is_zero(bytes, count)) {
      return count == 0u;
    }
  }
}

void ilk_recording_seal_header(ilk_recording_header_t *header) {
  header->magic = ILK_RECORDING_MAGIC;
  header->crc = ilk_recording_crc((const uint32_t *)header, CRC_WORDS(ilk_recording_header_t, crc));
}

ilk_block_header_t ilk_recording_block_header(uint32_t number, const uint32_t *payload, uint32_t used) {
  ilk_block_header_t header = {.magic = ILK_BLOCK_MAGIC,
                               .number = number,
                               .used = used,
                               .payload_crc = ilk_recording_crc(payload, used)};
  header.header_crc = ilk_recording_crc((const uint32_t *)&header, CRC_WORDS(ilk_block_header_t, header_crc));
  return header;
}

ilk_header_result_t ilk_recording_begin(ilk_recording_t *recording, FILE *file) {
  ilk_recording_header_t *header = &recording->header;
  recording->file = file;
  recording->offset = 0u;
  recording->number = 0u;
  recording->used = 0u;
  if (fread(header, sizeof *header, 1u, file) != 1u || header->magic != ILK_RECORDING_MAGIC) {
    return ILK_HEADER_NO_RECORDING;
  }
  if (header->run.version != ILK_RECORDING_VERSION || header->run.frame_words != (uint32_t)ILK_FRAME_WORDS ||
      header->run.layout_hash != ilk_recording_layout_hash()) {
    return ILK_HEADER_OTHER_RELEASE;
  }
  if (header->crc != ilk_recording_crc((const uint32_t *)header, CRC_WORDS(ilk_recording_header_t, crc))) {
    return ILK_HEADER_DAMAGED;
  }
  recording->offset = sizeof *header;
  return ILK_HEADER_GOOD;
}

static bool header_is_sound(const ilk_block_header_t *header) {
  return header->magic == ILK_BLOCK_MAGIC && header->number != 0u && header->used <= ILK_PAYLOAD_WORDS_MAX &&
         header->header_crc ==
             ilk_recording_crc((const uint32_t *)header, CRC_WORDS(ilk_block_header_t, header_crc));
}

/** A payload whose end was never written ends with zeros, and so does the file. */
static ilk_file_result_t judge_payload(ilk_recording_t *recording, const ilk_block_header_t *header) {
  const uint32_t *payload = recording->payload;
  const uint32_t trailer = payload[header->used];
  if (trailer == ILK_BLOCK_TRAILER(header->number) &&
      ilk_recording_crc(payload, header->used) == header->payload_crc) {
    recording->used = header->used;
    return ILK_FILE_BLOCK;
  }
  return trailer == 0u && rest_is_zero(recording->file) ? ILK_FILE_TORN : ILK_FILE_DAMAGED;
}

ilk_file_result_t ilk_recording_next(ilk_recording_t *recording) {
  ilk_block_header_t header;
  if (recording->number != 0u) {
    recording->offset += sizeof header + (((uint64_t)recording->used + 1u) * sizeof(uint32_t));
  }
  recording->number = 0u;
  recording->used = 0u;
  const size_t got = fread(&header, 1u, sizeof header, recording->file);
  if (got == 0u) {
    return ILK_FILE_END;
  }
  if (got < sizeof header) {
    return ILK_FILE_TORN;
  }
  if (!header_is_sound(&header)) {
    return is_zero(&header, sizeof header) && rest_is_zero(recording->file) ? ILK_FILE_TORN
                                                                            : ILK_FILE_DAMAGED;
  }
  recording->number = header.number;
  const size_t words = (size_t)header.used + 1u;
  if (fread(recording->payload, sizeof(uint32_t), words, recording->file) != words) {
    return ILK_FILE_TORN;
  }
  return judge_payload(recording, &header);
}
