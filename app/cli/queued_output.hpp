/**
 * @file
 * An output whose writers never wait for its reader.
 */
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <ostream>
#include <streambuf>
#include <string>

#include "system/file_descriptor.hpp"

namespace interlock::cli {

/**
 * Writes whole lines to a pipe, from which a process of its own copies them to a descriptor: one that nobody
 * reads, or a stopped terminal, holds up nobody. Lines that find no room in the pipe are lost; a line tells
 * how many, at the next line or flush that finds room. At its end it waits a second at most for the copy.
 *
 * No thread does that: with one in this process, the children of `interlock run` would be told twice that it
 * died.
 */
class QueuedOutput {
 public:
  /** Throws std::system_error when the system gives neither pipe nor process. */
  explicit QueuedOutput(int fd);
  ~QueuedOutput();
  QueuedOutput(const QueuedOutput&) = delete;
  QueuedOutput& operator=(const QueuedOutput&) = delete;

  /** What is written to it is queued. */
  [[nodiscard]] std::ostream& stream() { return stream_; }

 private:
  class Lines final : public std::streambuf {
   public:
    /** Into this pipe, which never lets a writer wait. */
    explicit Lines(int pipe) : pipe_(pipe) {}

    /** Whether nothing waits any more. */
    bool write_waiting();

   protected:
    int_type overflow(int_type letter) override;
    int sync() override;

   private:
    void write_some();

    int pipe_;
    std::string line_;    /**< not complete yet */
    std::string waiting_; /**< the rest of the one that goes next */
    std::uint64_t lost_ = 0;
  };

  pid_t copier_ = 0;
  FileDescriptor pipe_; /**< after `copier_`, which its making sets */
  FileDescriptor copier_end_;
  Lines lines_;
  std::ostream stream_{&lines_};
};

}  // namespace interlock::cli
