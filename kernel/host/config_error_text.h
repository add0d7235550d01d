/**
 * @file
 * Name and meaning of each `ilk_config_error_t`, for the kernel's start-up report.
 */
#ifndef INTERLOCK_HOST_CONFIG_ERROR_TEXT_H
#define INTERLOCK_HOST_CONFIG_ERROR_TEXT_H

#include <stdint.h>

#include "interlock/catalog.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  const char *name;
  const char *meaning;
} ilk_config_error_text_t;

/** Text of an error; total: a number that is no error gets a text that says so. */
ilk_config_error_text_t ilk_config_error_text(uint32_t error);

#ifdef __cplusplus
}
#endif

#endif
