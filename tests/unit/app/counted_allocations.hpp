/**
 * @file
 * Counts what one thread allocates: this test program's `operator new` is its own.
 */
#pragma once

#include <pthread.h>

#include <cstdint>

namespace interlock::test {

/** Counts from zero what that thread allocates from now on; no thread by default. */
void count_allocations_of(pthread_t thread = {});

[[nodiscard]] std::uint32_t counted_allocations();

}  // namespace interlock::test
