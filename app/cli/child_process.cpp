#include "cli/child_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
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

std::vector<char*> argument_vector(const Program& program, std::vector<std::string>& storage) {
  storage = program.arguments;
  storage.insert(storage.begin(), program.file.string());
  std::vector<char*> arguments;
  for (std::string& argument : storage) {
    arguments.push_back(argument.data());
  }
  arguments.push_back(nullptr);
  return arguments;
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
[[noreturn]] void become(char* const arguments[], const cpu_set_t& cores, int output, int null_input,
                         pid_t parent, int signal_at_parents_end) {
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
  execv(arguments[0], arguments);
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
  UniqueFd null_input(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!null_input || pipe2(ends.data(), O_CLOEXEC) != 0) {
    return failed(ExitCode::process_ended, program.name + " cannot be started: " + last_error());
  }
  UniqueFd reader(ends[0]);
  const UniqueFd writer(ends[1]);
  fcntl(reader.get(), F_SETFL, O_NONBLOCK);

  std::vector<std::string> storage;
  const std::vector<char*> arguments = argument_vector(program, storage);
  const cpu_set_t cores = cores_of(program);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    become(arguments.data(), cores, writer.get(), null_input.get(), parent,
           program.outlives_parent ? SIGTERM : SIGKILL);
  }
  if (pid < 0) {
    return failed(ExitCode::process_ended, program.name + " cannot be started: " + last_error());
  }
  ChildProcess child(pid, UniqueFd(pidfd_open(pid, 0)), std::move(reader));
  if (!child.pidfd_) {
    return failed(ExitCode::process_ended, program.name + " cannot be watched: " + last_error());
  }
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)),
      pidfd_(std::move(other.pidfd_)),
      output_(std::move(other.output_)),
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

std::vector<std::string> ChildProcess::read_lines(bool rest) {
  std::vector<std::string> lines;
  std::array<char, 4096> chunk{};
  for (int count = 0; count < chunks_at_a_time && output_; ++count) {
    const ssize_t length = read(output_.get(), chunk.data(), chunk.size());
    if (length < 0) {
      break;
    }
    if (length == 0) {
      output_ = UniqueFd();
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
