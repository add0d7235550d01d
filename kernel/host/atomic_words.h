/**
 * @file
 * Words that two processes share: copied one by one, each access atomic, so that concurrent writing
 * can give a stale or mixed record but never undefined behaviour.
 */
#ifndef INTERLOCK_HOST_ATOMIC_WORDS_H
#define INTERLOCK_HOST_ATOMIC_WORDS_H

#include <stddef.h>
#include <stdint.h>

/** Copies words that another process may write, each whole. */
static inline void ilk_words_load(uint32_t *private_words, const uint32_t *shared_words, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    private_words[i] = __atomic_load_n(&shared_words[i], __ATOMIC_RELAXED);
  }
}

/** Copies words to where another process may read them, each whole. */
static inline void ilk_words_store(uint32_t *shared_words, const uint32_t *private_words, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    __atomic_store_n(&shared_words[i], private_words[i], __ATOMIC_RELAXED);
  }
}

#endif
