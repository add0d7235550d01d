/**
 * @file
 * Owner of a file descriptor.
 */
#ifndef INTERLOCK_PLANT_SIM_FILE_DESCRIPTOR_HPP
#define INTERLOCK_PLANT_SIM_FILE_DESCRIPTOR_HPP

#include <unistd.h>

#include <utility>

namespace interlock::plant::sim {

/** Closes its descriptor when it goes. */
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }

  int get() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

}  // namespace interlock::plant::sim

#endif
