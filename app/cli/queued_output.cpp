#include "cli/queued_output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

namespace interlock::cli {
namespace {

constexpr std::chrono::seconds longest_end{1};

/** Waits for the reader, even of a descriptor that somebody made non-blocking. */
void write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t length = write(fd, text.data(), text.size());
    if (length >= 0) {
      text.remove_prefix(static_cast<std::size_t>(length));
    } else if (errno == EAGAIN) {
      pollfd room{fd, POLLOUT, 0};
      poll(&room, 1, -1);
    } else if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "write");
    }
  }
}

}  // namespace

QueuedOutput::Lines::Lines(int fd)
    : fd_(fd), thread_([fd](std::uint64_t lost) {
        write_all(fd, "interlock: " + std::to_string(lost) +
                          (lost == 1 ? " line was lost" : " lines were lost") +
                          ": nobody read them in time\n");
      }) {}

QueuedOutput::Lines::int_type QueuedOutput::Lines::overflow(int_type letter) {
  line_ += traits_type::to_char_type(letter);
  if (line_.back() == '\n') {
    thread_.add([fd = fd_, line = std::exchange(line_, {})] { write_all(fd, line); });
  }
  return letter;
}

QueuedOutput::QueuedOutput(int fd) : lines_(fd) {}

QueuedOutput::~QueuedOutput() { lines_.thread().wait_until_done(WritingThread::Clock::now() + longest_end); }

}  // namespace interlock::cli
