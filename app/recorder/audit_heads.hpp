/**
 * @file
 * The heads of the app's audit, kept where the app cannot write: it reports them on a socket, and they are
 * only ever appended to a file. `interlock audit verify` and each start of the app compare the audit with
 * them.
 */
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "recorder/recorder_error.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::recorder {

class AuditHeads {
 public:
  /** The shortest time between two lines, of which the second has the newest head. */
  static constexpr std::chrono::seconds pause{10};

  /** Takes heads on `socket`, which the group may use, too, and appends them to `file`. */
  static Recorded<AuditHeads> open(const std::filesystem::path& socket, const std::filesystem::path& file);

  /** Takes what was reported since, and appends the newest head when the pause is over. */
  void step();

  /** Takes what was reported since, and appends the newest head now. */
  void finish();

 private:
  AuditHeads(FileDescriptor socket, FileDescriptor file)
      : socket_(std::move(socket)), file_(std::move(file)) {}

  void receive();
  void append();

  FileDescriptor socket_;
  FileDescriptor file_;
  std::string newest_;   /**< "NUMBER HASH" */
  std::string appended_; /**< the newest one that is on the disk */
  std::chrono::steady_clock::time_point next_;
};

}  // namespace interlock::recorder
