#include "counted_allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<pthread_t> watched{};
std::atomic<std::uint32_t> allocations{0};

}  // namespace

void* operator new(std::size_t bytes) {
  if (pthread_equal(pthread_self(), watched.load(std::memory_order_relaxed)) != 0) {
    allocations.fetch_add(1, std::memory_order_relaxed);
  }
  void* memory = std::malloc(bytes);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete(void* memory) noexcept { std::free(memory); }

void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace interlock::test {

void count_allocations_of(pthread_t thread) {
  allocations = 0;
  watched = thread;
}

std::uint32_t counted_allocations() { return allocations; }

}  // namespace interlock::test
