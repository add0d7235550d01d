#include "cli/password_prompt.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>

#include "system/file_descriptor.hpp"

namespace interlock::cli {
namespace {

/** More than any password has; room for it is made beforehand, so that none is left behind where it grew. */
constexpr std::size_t longest_typed = 1024;

void interrupt(int /*signal*/) {}

/** The terminal without echo. A signal that would end the program ends the wait for input instead, so that
 * the echo comes back. It is held back until then: one between two waits is not lost. */
class Silence {
 public:
  explicit Silence(int terminal) : terminal_(terminal) {
    struct sigaction action{};
    action.sa_handler = interrupt;
    sigset_t held;
    ::sigemptyset(&held);
    for (const int signal : signals) {
      ::sigaddset(&held, signal);
    }
    ::sigprocmask(SIG_BLOCK, &held, &mask_);
    for (std::size_t at = 0; at < signals.size(); ++at) {
      ::sigaction(signals[at], &action, &before_[at]);
    }
    silent_ = ::tcgetattr(terminal_, &attributes_) == 0;
    termios silent = attributes_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    silent_ = silent_ && ::tcsetattr(terminal_, TCSAFLUSH, &silent) == 0;
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence() {
    if (silent_) {
      ::tcsetattr(terminal_, TCSAFLUSH, &attributes_);
    }
    for (std::size_t at = 0; at < signals.size(); ++at) {
      ::sigaction(signals[at], &before_[at], nullptr);
    }
    ::sigprocmask(SIG_SETMASK, &mask_, nullptr);
  }

  /** False with EINTR when a signal came, before or during the wait. */
  [[nodiscard]] bool wait_for_input() const {
    pollfd input{.fd = terminal_, .events = POLLIN, .revents = 0};
    return ::ppoll(&input, 1, nullptr, &mask_) == 1;
  }

  explicit operator bool() const { return silent_; }

 private:
  static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

  int terminal_;
  bool silent_ = false;
  termios attributes_{};
  sigset_t mask_{};
  std::array<struct sigaction, signals.size()> before_{};
};

tl::unexpected<Failure> not_read(int error_number) {
  return failed(ExitCode::precondition,
                error_number == EINTR
                    ? "interrupted; nothing was changed"
                    : "the password cannot be read: " + std::generic_category().message(error_number));
}

Result<Password> read_line(int file) {
  std::string line;
  line.reserve(longest_typed);
  char byte = 0;
  ssize_t count = 0;
  while ((count = ::read(file, &byte, 1)) == 1 && byte != '\n' && line.size() < longest_typed) {
    line += byte;
  }
  const int error_number = errno;
  Password password(std::move(line));
  if (count < 0) {
    return not_read(error_number);
  }
  if (count == 0 && password.text().empty()) {
    return failed(ExitCode::precondition, "no password was given; nothing was changed");
  }
  return password;
}

void show(int terminal, std::string_view text) {
  // A prompt that cannot be shown is no reason not to listen.
  [[maybe_unused]] const ssize_t shown = ::write(terminal, text.data(), text.size());
}

Result<Password> ask(int terminal, const Silence& silence, const std::string& prompt) {
  show(terminal, prompt);
  Result<Password> password = silence.wait_for_input() ? read_line(terminal) : not_read(errno);
  show(terminal, "\n");
  return password;
}

}  // namespace

Result<Password> ask_for_new_password(const std::string& user) {
  const FileDescriptor terminal(::open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY));
  if (!terminal) {
    return failed(ExitCode::precondition,
                  "there is no terminal to ask for the password; give it with --password-stdin");
  }
  const Silence silence(terminal.get());
  if (!silence) {
    return failed(ExitCode::precondition,
                  "the terminal would show the password; give it with --password-stdin");
  }
  Result<Password> first = ask(terminal.get(), silence, "New password of " + user + ": ");
  if (!first) {
    return first;
  }
  const Result<Password> second = ask(terminal.get(), silence, "Once more: ");
  if (!second) {
    return tl::unexpected(second.error());
  }
  if (first->text() != second->text()) {
    return failed(ExitCode::refused, "the two passwords differ; nothing was changed");
  }
  return first;
}

Result<Password> read_password() { return read_line(STDIN_FILENO); }

}  // namespace interlock::cli
