/**
 * @file
 * One program of Interlock as a child of this one.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/exit_code.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::cli {

/** What is to be started. */
struct Program {
  std::string name; /**< as people know it: "kernel" */
  std::filesystem::path file;
  std::vector<std::string> arguments;
  std::optional<std::uint32_t> kept_off_core =
      std::nullopt;                      /**< a core on which none of its threads may run */
  bool outlives_parent = false;          /**< is asked to end, not killed, when its parent dies */
  std::chrono::milliseconds watchdog{0}; /**< it has to give a sign of life this often; 0: it gives none */
};

/** How a child ended, in words: "exit code 2", "killed by signal 9 (Killed)". */
std::string describe_end(int wait_status);

/**
 * A running child. It ends when its parent dies, has a process group of its own, so that Ctrl-C reaches only
 * the parent, and writes standard output and standard error into one pipe.
 */
class ChildProcess {
 public:
  /** Starts the program; its output comes through a pipe. */
  static Result<ChildProcess> start(const Program& program);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /** Kills what still runs, its own children included, and waits for it. */
  ~ChildProcess();

  /** Readable when the child has ended. */
  [[nodiscard]] int end_fd() const { return pidfd_.get(); }

  /** Readable when there is output, or the end of it; -1 after that end. */
  [[nodiscard]] int output_fd() const { return output_.get(); }

  /** Readable when there may be a sign of life; -1 for a program without a watchdog. */
  [[nodiscard]] int life_fd() const { return life_.get(); }

  /** Whether the child, as a service does by $NOTIFY_SOCKET, has given a sign of life since the last call. */
  [[nodiscard]] bool gave_sign_of_life() const;

  /** Sends a signal to the process. */
  void send(int signal) const;

  /** Complete lines written since the last call, without waiting; with `rest`, an incomplete last one
   * besides. */
  std::vector<std::string> read_lines(bool rest);

  /** The wait status of the ended child, whose own children are killed; empty while it still runs. */
  std::optional<int> reap();

 private:
  ChildProcess(pid_t pid, FileDescriptor pidfd, FileDescriptor output, FileDescriptor life)
      : pid_(pid), pidfd_(std::move(pidfd)), output_(std::move(output)), life_(std::move(life)) {}

  pid_t pid_; /**< 0 once reaped */
  FileDescriptor pidfd_;
  FileDescriptor output_;
  FileDescriptor life_;
  std::string unfinished_line_;
};

}  // namespace interlock::cli
