/**
 * @file
 * A memory mapping that ends with its owner.
 */
#pragma once

#include <cstddef>

#include "system/file_descriptor.hpp"

namespace interlock {

/** Owns one shared mapping of the start of a file, or none. */
class SharedMapping {
 public:
  /** What the mapping may be used for. */
  enum class Access { read_only, read_write };

  SharedMapping() = default;
  /** Maps `bytes` of `fd`; `data()` is null and errno is set when the system refuses. */
  SharedMapping(const FileDescriptor& fd, std::size_t bytes, Access access) noexcept;
  SharedMapping(SharedMapping&& other) noexcept;
  SharedMapping& operator=(SharedMapping&& other) noexcept;
  ~SharedMapping();

  [[nodiscard]] void* data() const noexcept { return data_; }

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace interlock
