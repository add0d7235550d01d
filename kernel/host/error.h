/**
 * @file
 * Why something failed before the loop ran, in words for the operator.
 */
#ifndef INTERLOCK_HOST_ERROR_H
#define INTERLOCK_HOST_ERROR_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  char text[512];
} ilk_error_t;

/** Writes the reason, `printf` style, and returns false, so that a failing function can return it. */
bool ilk_fail(ilk_error_t *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __cplusplus
}
#endif

#endif
