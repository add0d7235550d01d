#include "cli/queued_output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <system_error>
#include <utility>

// This header of glibc 2.36 does not say by itself that its functions are C.
extern "C" {
#include <sys/pidfd.h>
}

namespace interlock::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds longest_end{1};

/** What any user may ask for; room for some thousand lines. */
constexpr int pipe_bytes = 1 << 20;

/** Waits for the reader, even of a descriptor that somebody made non-blocking; false when there is none. */
bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t length = write(fd, text.data(), text.size());
    if (length >= 0) {
      text.remove_prefix(static_cast<std::size_t>(length));
    } else if (errno == EAGAIN) {
      pollfd room{fd, POLLOUT, 0};
      poll(&room, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

/** The other process: copies until there is nothing more to come. A signal to all of a terminal is not for
 * it. */
[[noreturn]] void copy(int from, int to, pid_t parent) {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::array<char, 65536> text{};
  bool read_by_somebody = getppid() == parent;
  ssize_t length = 0;
  while ((length = read(from, text.data(), text.size())) > 0) {
    read_by_somebody = read_by_somebody && write_all(to, {text.data(), static_cast<std::size_t>(length)});
  }
  _exit(0);
}

int milliseconds_until(Clock::time_point then) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(then - Clock::now());
  return static_cast<int>(std::max<std::chrono::milliseconds::rep>(left.count(), 0));
}

bool wait_for(int fd, short event, Clock::time_point then) {
  pollfd polled{fd, event, 0};
  return poll(&polled, 1, milliseconds_until(then)) > 0;
}

FileDescriptor start_copier(int to, pid_t& copier) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "pipe");
  }
  const FileDescriptor reader(ends[0]);
  FileDescriptor writer(ends[1]);
  fcntl(writer.get(), F_SETPIPE_SZ, pipe_bytes);
  fcntl(writer.get(), F_SETFL, O_NONBLOCK);
  const pid_t parent = getpid();
  copier = fork();
  if (copier < 0) {
    throw std::system_error(errno, std::generic_category(), "fork");
  }
  if (copier == 0) {
    close(writer.get());
    copy(reader.get(), to, parent);
  }
  return writer;
}

}  // namespace

QueuedOutput::QueuedOutput(int fd)
    : pipe_(start_copier(fd, copier_)), copier_end_(pidfd_open(copier_, 0)), lines_(pipe_.get()) {
  if (!copier_end_) {
    throw std::system_error(errno, std::generic_category(), "pidfd_open");
  }
}

QueuedOutput::~QueuedOutput() {
  const Clock::time_point then = Clock::now() + longest_end;
  while (!lines_.write_waiting() && wait_for(pipe_.get(), POLLOUT, then)) {
  }
  pipe_ = FileDescriptor();
  if (!wait_for(copier_end_.get(), POLLIN, then)) {
    pidfd_send_signal(copier_end_.get(), SIGKILL, nullptr, 0);
    wait_for(copier_end_.get(), POLLIN, Clock::now() + longest_end);
  }
  // One that not even SIGKILL ends, at a frozen disk, is left to the system.
  waitpid(copier_, nullptr, WNOHANG);
}

bool QueuedOutput::Lines::write_waiting() {
  write_some();
  if (waiting_.empty() && lost_ > 0) {
    const std::uint64_t lost = std::exchange(lost_, 0);
    waiting_ = "interlock: " + std::to_string(lost) + (lost == 1 ? " line was lost" : " lines were lost") +
               ": nobody read them in time\n";
    write_some();
  }
  return waiting_.empty();
}

void QueuedOutput::Lines::write_some() {
  while (!waiting_.empty()) {
    const ssize_t length = write(pipe_, waiting_.data(), waiting_.size());
    if (length >= 0) {
      waiting_.erase(0, static_cast<std::size_t>(length));
    } else if (errno != EINTR) {
      return;
    }
  }
}

QueuedOutput::Lines::int_type QueuedOutput::Lines::overflow(int_type letter) {
  line_ += traits_type::to_char_type(letter);
  if (line_.back() == '\n') {
    if (write_waiting()) {
      waiting_ = std::move(line_);
      write_some();
    } else {
      ++lost_;
    }
    line_.clear();
  }
  return letter;
}

int QueuedOutput::Lines::sync() {
  write_waiting();
  return 0;
}

}  // namespace interlock::cli
