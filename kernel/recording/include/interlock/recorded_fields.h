/**
 * @file
 * The name of each recorded word, such as `state.axis[3].lease_ticks`.
 */
#ifndef INTERLOCK_RECORDED_FIELDS_H
#define INTERLOCK_RECORDED_FIELDS_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/recording.h"

struct ilk_field_table;

/** One field of a structure. */
typedef struct {
  const char *name;
  uint32_t offset;                     /**< in its structure, bytes */
  uint32_t bytes;                      /**< of the whole field */
  uint32_t element_bytes;              /**< of one element of an array, 0 for what is none */
  bool integer;                        /**< int32_t, shown with its sign */
  const struct ilk_field_table *inner; /**< of a structure or an array of them, or NULL */
} ilk_field_t;

/** The fields of a structure, which leave no gap. */
typedef struct ilk_field_table {
  const ilk_field_t *field;
  uint32_t count;
  uint32_t bytes; /**< of the structure */
} ilk_field_table_t;

/** What a word is called. */
typedef struct {
  char text[96];
  bool integer;
} ilk_word_name_t;

#ifdef __cplusplus
extern "C" {
#endif

/** The fields of what is recorded each tick. */
const ilk_field_table_t *ilk_picture_fields(void);
/** The fields of a request. */
const ilk_field_table_t *ilk_request_fields(void);
/** The fields of a configuration. */
const ilk_field_table_t *ilk_config_fields(void);

/** The name of the word at a byte offset; empty outside of the structure. */
ilk_word_name_t ilk_word_name(const ilk_field_table_t *table, uint32_t offset);

#ifdef __cplusplus
}
#endif

#endif
