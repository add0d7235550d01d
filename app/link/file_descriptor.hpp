/**
 * @file
 * An open file descriptor and a memory mapping, each closed by its owner's destructor.
 */
#pragma once

#include <cstddef>
#include <utility>

namespace interlock {

/** Owns one open descriptor, or none. */
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) noexcept : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();

  [[nodiscard]] int get() const noexcept { return fd_; }
  /** Gives the descriptor away, which nobody closes then. */
  [[nodiscard]] int release() noexcept { return std::exchange(fd_, -1); }
  [[nodiscard]] bool open() const noexcept { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

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
