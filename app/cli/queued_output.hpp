/**
 * @file
 * An output whose writers never wait for its reader.
 */
#pragma once

#include <ostream>
#include <streambuf>
#include <string>

#include "log/writing_thread.hpp"

namespace interlock::cli {

/**
 * Writes whole lines to a descriptor in a thread of its own: a pipe that nobody reads, or a stopped terminal,
 * holds up nobody. Lines that find no room are lost; a line tells how many as soon as there is room. At its
 * end it waits for what is still to be written, for a second at most.
 */
class QueuedOutput {
 public:
  explicit QueuedOutput(int fd);
  ~QueuedOutput();

  [[nodiscard]] std::ostream& stream() { return stream_; }

 private:
  class Lines final : public std::streambuf {
   public:
    explicit Lines(int fd);
    WritingThread& thread() { return thread_; }

   protected:
    int_type overflow(int_type letter) override;

   private:
    int fd_;
    std::string line_;
    WritingThread thread_;
  };

  Lines lines_;
  std::ostream stream_{&lines_};
};

}  // namespace interlock::cli
