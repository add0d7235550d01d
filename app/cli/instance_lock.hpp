/**
 * @file
 * One instance for each state directory.
 */
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/exit_code.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::cli {

/**
 * Holds a state directory for as long as it lives. The system lets go of it when the process ends, however it
 * ends.
 *
 * The lock file says who holds it and which private directory they use, so that a second instance can name
 * the first, and the one after a crash can clear away what it left.
 */
class InstanceLock {
 public:
  /** Takes the directory, made if missing. Refused, without touching anything, while another process holds
   * it. */
  static Result<InstanceLock> take(const std::filesystem::path& directory);

  /** Writes down who holds the directory, and where its kernel hands out its black box. */
  void describe(const std::string& url, const std::filesystem::path& runtime_directory,
                const std::filesystem::path& black_box) const;

  InstanceLock(InstanceLock&&) = default;
  InstanceLock& operator=(InstanceLock&&) = default;

  /** Leaves the lock file, empty: the sign of an orderly end. */
  ~InstanceLock();

 private:
  explicit InstanceLock(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
};

/** Socket of the black box of the instance that runs with this state directory, or was killed; nothing when
 * none does. */
std::optional<std::filesystem::path> running_black_box(const std::filesystem::path& directory);

}  // namespace interlock::cli
