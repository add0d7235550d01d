#include "interlock/recorded_fields.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "parts.h"
#include "recorded_field_tables.h"

const ilk_field_table_t *ilk_picture_fields(void) { return &table_of_ilk_picture_t; }
const ilk_field_table_t *ilk_request_fields(void) { return &table_of_ilk_request_t; }
const ilk_field_table_t *ilk_config_fields(void) { return &table_of_ilk_config_t; }

static const ilk_field_t *field_at(const ilk_field_table_t *table, uint32_t offset) {
  for (uint32_t i = 0u; i < table->count; ++i) {
    const ilk_field_t *field = &table->field[i];
    if (offset >= field->offset && offset - field->offset < field->bytes) {
      return field;
    }
  }
  return NULL;
}

static void append_text(ilk_word_name_t *name, const char *text) {
  const size_t length = strlen(name->text);
  (void)snprintf(&name->text[length], sizeof name->text - length, "%s", text);
}

static void append_number(ilk_word_name_t *name, uint32_t number) {
  const size_t length = strlen(name->text);
  (void)snprintf(&name->text[length], sizeof name->text - length, "[%u]", number);
}

/** Appends `[n]` for each dimension of an array of words or structures; returns the offset in the element. */
static uint32_t append_index(ilk_word_name_t *name, const ilk_field_t *field, uint32_t offset) {
  if (field->element_bytes == 0u) {
    return offset;
  }
  append_number(name, offset / field->element_bytes);
  const uint32_t rest = offset % field->element_bytes;
  if (field->inner == NULL && field->element_bytes > sizeof(uint32_t)) {
    append_number(name, rest / (uint32_t)sizeof(uint32_t));
  }
  return rest;
}

ilk_word_name_t ilk_word_name(const ilk_field_table_t *table, uint32_t offset) {
  ilk_word_name_t name = {.text = "", .integer = false};
  while (table != NULL) {
    const ilk_field_t *field = field_at(table, offset);
    if (field == NULL) {
      name.text[0] = '\0';
      return name;
    }
    append_text(&name, name.text[0] == '\0' ? "" : ".");
    append_text(&name, field->name);
    offset = append_index(&name, field, offset - field->offset);
    name.integer = field->integer;
    table = field->inner;
  }
  return name;
}

static uint32_t crc_of_name(uint32_t crc, const char *name) {
  for (; *name != '\0'; ++name) {
    crc = ilk_crc32_word(crc, (unsigned char)*name);
  }
  return crc;
}

/** Structures nest two deep, so the recursion does. */
static uint32_t crc_of_table(uint32_t crc, const ilk_field_table_t *table) {
  crc = ilk_crc32_word(crc, table->bytes);
  for (uint32_t i = 0u; i < table->count; ++i) {
    const ilk_field_t *field = &table->field[i];
    crc = crc_of_name(crc, field->name);
    crc = ilk_crc32_word(crc, field->offset);
    crc = ilk_crc32_word(crc, field->bytes);
    crc = ilk_crc32_word(crc, field->element_bytes);
    if (field->inner != NULL) {
      crc = crc_of_table(crc, field->inner);
    }
  }
  return crc;
}

uint32_t ilk_recording_layout_hash(void) {
  uint32_t crc = crc_of_table(ILK_CRC32_START, ilk_picture_fields());
  crc = crc_of_table(crc, ilk_request_fields());
  crc = crc_of_table(crc, ilk_config_fields());
  crc = ilk_crc32_word(crc, (uint32_t)sizeof(ilk_tick_record_t));
  return crc ^ ILK_CRC32_START;
}
