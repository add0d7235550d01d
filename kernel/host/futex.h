/**
 * @file
 * The futex calls that glibc does not wrap. Shared between processes, hence never the private variants.
 */
#ifndef INTERLOCK_HOST_FUTEX_H
#define INTERLOCK_HOST_FUTEX_H

#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/** Wakes at most `waiters` waiters on `word`. */
void ilk_futex_wake(uint32_t *word, uint32_t waiters);

/**
 * Waits while `word` has `value`, at most for `timeout`. `word` may be mapped read-only.
 *
 * @return true when woken or when `word` has another value, false on timeout or interruption.
 */
bool ilk_futex_wait(const uint32_t *word, uint32_t value, const struct timespec *timeout);

#endif
