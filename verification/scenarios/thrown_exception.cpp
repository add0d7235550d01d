/**
 * @file
 * An exception that nobody expects, in a thread of choice of a program that is started with this library
 * preloaded.
 *
 * The file $INTERLOCK_THROW_IN (16 bytes, mapped) holds the name of a thread, as `top -H` shows it, or
 * "main": the next allocation of that thread throws std::bad_alloc, and the name is gone.
 */
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>

namespace {

constexpr std::size_t name_bytes = 16;

char* thread_name = nullptr;

__attribute__((constructor)) void map_name() {
  const char* path = std::getenv("INTERLOCK_THROW_IN");
  const int file = path == nullptr ? -1 : open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) {
    return;
  }
  void* mapped = mmap(nullptr, name_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (mapped != MAP_FAILED) {
    thread_name = static_cast<char*>(mapped);
  }
  close(file);
}

bool is_chosen() {
  if (thread_name == nullptr || __atomic_load_n(thread_name, __ATOMIC_RELAXED) == '\0') {
    return false;
  }
  char own[name_bytes] = "main";
  if (gettid() != getpid()) {
    pthread_getname_np(pthread_self(), own, sizeof own);
  }
  return std::strncmp(own, thread_name, name_bytes) == 0;
}

}  // namespace

void* operator new(std::size_t size) {
  if (is_chosen()) {
    __atomic_store_n(thread_name, '\0', __ATOMIC_RELAXED);
    throw std::bad_alloc();
  }
  if (void* memory = std::malloc(size == 0 ? 1 : size)) {
    return memory;
  }
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
