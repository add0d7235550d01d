#include "cli/child_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <system_error>

// This header of glibc 2.36 does not say by itself that its functions are C.
extern "C" {
#include <sys/pidfd.h>
}

namespace interlock::cli {
namespace {

/** A program that never ends its line must not fill the memory. */
constexpr std::size_t longest_line = 65536;

/** One that never stops writing must not keep the others waiting. */
constexpr int chunks_at_a_time = 16;

std::string last_error() { return std::generic_category().message(errno); }

std::vector<std::string> arguments_of(const Program& program) {
  std::vector<std::string> arguments = program.arguments;
  arguments.insert(arguments.begin(), program.file.string());
  return arguments;
}

/** A datagram socket under an abstract name of its own, which names the sender of each message; none when the
 * system refuses. */
FileDescriptor life_socket() {
  FileDescriptor life(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_un any{AF_UNIX, {}};
  const int on = 1;
  const bool bound = bind(life.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any.sun_family) == 0 &&
                     setsockopt(life.get(), SOL_SOCKET, SO_PASSCRED, &on, sizeof on) == 0;
  return bound ? std::move(life) : FileDescriptor();
}

std::string abstract_name_of(const FileDescriptor& socket) {
  sockaddr_un address{};
  socklen_t length = sizeof address;
  getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &length);
  return '@' + std::string(address.sun_path + 1, length - offsetof(sockaddr_un, sun_path) - 1);
}

/** As this process has it, but the service manager of a child is this process. */
std::vector<std::string> environment_of(const Program& program, const FileDescriptor& life) {
  std::vector<std::string> environment;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view entry = *each;
    if (!entry.starts_with("NOTIFY_SOCKET=") && !entry.starts_with("WATCHDOG_")) {
      environment.emplace_back(entry);
    }
  }
  if (life) {
    environment.push_back("NOTIFY_SOCKET=" + abstract_name_of(life));
    environment.push_back("WATCHDOG_USEC=" +
                          std::to_string(std::chrono::microseconds(program.watchdog).count()));
  }
  return environment;
}

/** As exec takes it; the words must outlive it. */
std::vector<char*> vector_of(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

/** The cores that a program may use; threads and children inherit them. */
cpu_set_t cores_of(const Program& program) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof cores, &cores);
  if (program.kept_off_core) {
    CPU_CLR(*program.kept_off_core, &cores);
  }
  return cores;
}

/** Runs in the child between fork and exec, so only async-signal-safe calls are allowed. Does not return. */
[[noreturn]] void become(char* const arguments[], char* const environment[], const cpu_set_t& cores,
                         int output, int null_input, pid_t parent, int signal_at_parents_end) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  setpgid(0, 0);
  sched_setaffinity(0, sizeof cores, &cores);
  dup2(null_input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  prctl(PR_SET_PDEATHSIG, signal_at_parents_end);
  if (getppid() != parent) {
    _exit(1);  // The parent died before the line above could tie this process to it.
  }
  execve(arguments[0], arguments, environment);
  const char* const reason = strerrordesc_np(errno);
  constexpr std::string_view text = "cannot be run: ";
  [[maybe_unused]] ssize_t written = write(STDERR_FILENO, text.data(), text.size());
  written = write(STDERR_FILENO, reason, std::strlen(reason));
  _exit(127);
}

}  // namespace

std::string describe_end(int wait_status) {
  if (WIFSIGNALED(wait_status)) {
    const int signal = WTERMSIG(wait_status);
    return "killed by signal " + std::to_string(signal) + " (" + strsignal(signal) + ')';
  }
  return "exit code " + std::to_string(WEXITSTATUS(wait_status));
}

Result<ChildProcess> ChildProcess::start(const Program& program) {
  std::array<int, 2> ends{};
  FileDescriptor null_input(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!null_input || pipe2(ends.data(), O_CLOEXEC) != 0) {
    return failed(ExitCode::process_ended, program.name + " cannot be started: " + last_error());
  }
  FileDescriptor reader(ends[0]);
  const FileDescriptor writer(ends[1]);
  fcntl(reader.get(), F_SETFL, O_NONBLOCK);

  FileDescriptor life = program.watchdog.count() > 0 ? life_socket() : FileDescriptor();
  if (program.watchdog.count() > 0 && !life) {
    return failed(ExitCode::process_ended, program.name + " cannot be watched: " + last_error());
  }

  std::vector<std::string> argument_words = arguments_of(program);
  std::vector<std::string> environment_words = environment_of(program, life);
  const std::vector<char*> arguments = vector_of(argument_words);
  const std::vector<char*> environment = vector_of(environment_words);
  const cpu_set_t cores = cores_of(program);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    become(arguments.data(), environment.data(), cores, writer.get(), null_input.get(), parent,
           program.outlives_parent ? SIGTERM : SIGKILL);
  }
  if (pid < 0) {
    return failed(ExitCode::process_ended, program.name + " cannot be started: " + last_error());
  }
  ChildProcess child(pid, FileDescriptor(pidfd_open(pid, 0)), std::move(reader), std::move(life));
  if (!child.pidfd_) {
    return failed(ExitCode::process_ended, program.name + " cannot be watched: " + last_error());
  }
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)),
      pidfd_(std::move(other.pidfd_)),
      output_(std::move(other.output_)),
      life_(std::move(other.life_)),
      unfinished_line_(std::move(other.unfinished_line_)) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void ChildProcess::send(int signal) const {
  if (pid_ > 0) {
    kill(pid_, signal);
  }
}

bool ChildProcess::gave_sign_of_life() const {
  bool given = false;
  std::array<char, 256> text{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
  iovec part{text.data(), text.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  for (int count = 0; life_ && count < chunks_at_a_time; ++count) {
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(life_.get(), &message, 0);
    if (length < 0) {
      break;
    }
    const cmsghdr* const sender = CMSG_FIRSTHDR(&message);
    ucred credentials{};
    if (sender != nullptr && sender->cmsg_type == SCM_CREDENTIALS) {
      std::memcpy(&credentials, CMSG_DATA(sender), sizeof credentials);
    }
    // Anybody on the machine may send to an abstract name.
    given =
        given || (credentials.pid == pid_ &&
                  std::string_view(text.data(), static_cast<std::size_t>(length)).starts_with("WATCHDOG=1"));
  }
  return given;
}

std::vector<std::string> ChildProcess::read_lines(bool rest) {
  std::vector<std::string> lines;
  std::array<char, 4096> chunk{};
  for (int count = 0; count < chunks_at_a_time && output_; ++count) {
    const ssize_t length = read(output_.get(), chunk.data(), chunk.size());
    if (length < 0) {
      break;
    }
    if (length == 0) {
      output_ = FileDescriptor();
    }
    for (const char letter : std::string_view(chunk.data(), static_cast<std::size_t>(length))) {
      if (letter != '\n') {
        unfinished_line_ += letter;
      }
      if (letter == '\n' || unfinished_line_.size() >= longest_line) {
        lines.push_back(std::exchange(unfinished_line_, {}));
      }
    }
  }
  if (rest && !unfinished_line_.empty()) {
    lines.push_back(std::exchange(unfinished_line_, {}));
  }
  return lines;
}

std::optional<int> ChildProcess::reap() {
  siginfo_t ended{};
  if (pid_ <= 0 || waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      ended.si_pid != pid_) {
    return std::nullopt;
  }
  // The group keeps its number until its leader is reaped: no stranger can be hit.
  kill(-pid_, SIGKILL);
  int status = 0;
  waitpid(std::exchange(pid_, 0), &status, 0);
  return status;
}

}  // namespace interlock::cli
