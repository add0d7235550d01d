/**
 * @file
 * Every field of every structure that crosses the link, in the order of its offset.
 *
 * layout_fields.h is generated from link.h and types.h at build time.
 */
#ifndef INTERLOCK_HOST_LAYOUT_TABLE_H
#define INTERLOCK_HOST_LAYOUT_TABLE_H

#include <stddef.h>
#include <stdint.h>

#include "interlock/link.h"
#include "layout_fields.h"

/** Where one field sits. */
typedef struct {
  uint32_t struct_bytes; /**< size of the structure that holds it */
  uint32_t offset;
  uint32_t bytes;
} ilk_layout_field_t;

#define ILK_LAYOUT_ENTRY(type, member) \
  {(uint32_t)sizeof(type), (uint32_t)offsetof(type, member), (uint32_t)sizeof(((type *)0)->member)},

#ifdef __cplusplus
extern "C" {
#endif

/** CRC-32 (IEEE 802.3, reflected) over the entries, each word least significant byte first. */
uint32_t ilk_layout_crc(const ilk_layout_field_t fields[], size_t count);

#ifdef __cplusplus
}
#endif

#endif
