/**
 * @file
 * The compiled configuration on disk: the bytes of `ilk_config_t`.
 */
#ifndef INTERLOCK_HOST_CONFIG_FILE_H
#define INTERLOCK_HOST_CONFIG_FILE_H

#include "error.h"
#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Reads and validates. `error` names the file and the rule that it breaks, with the slot if there is one. */
bool ilk_config_load(const char *path, ilk_config_t *config, ilk_error_t *error);

#ifdef __cplusplus
}
#endif

#endif
