#include "link/shared_mapping.hpp"

#include <sys/mman.h>

#include <utility>

namespace interlock {

SharedMapping::SharedMapping(const FileDescriptor& fd, std::size_t bytes, Access access) noexcept {
  const int protection = access == Access::read_write ? PROT_READ | PROT_WRITE : PROT_READ;
  void* data = ::mmap(nullptr, bytes, protection, MAP_SHARED, fd.get(), 0);
  if (data != MAP_FAILED) {
    data_ = data;
    bytes_ = bytes;
  }
}

SharedMapping::SharedMapping(SharedMapping&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

SharedMapping& SharedMapping::operator=(SharedMapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

SharedMapping::~SharedMapping() {
  if (data_ != nullptr) {
    ::munmap(data_, bytes_);
  }
}

}  // namespace interlock
