/**
 * @file
 * Starts the processes of one robot, watches them, and leaves none behind.
 *
 * Programs start one after the other, each when the one before has printed its line `ready`. From then on the
 * supervisor only waits for events: a signal, the end of a child, a line of output, a sign of life that is
 * due. It never sleeps.
 */
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/child_process.hpp"
#include "cli/exit_code.hpp"
#include "cli/restart_budget.hpp"
#include "cli/watchdog.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::cli {

/** Termination signals as events, blocked for this process for as long as this lives. */
class SignalEvents {
 public:
  SignalEvents();
  ~SignalEvents();
  SignalEvents(const SignalEvents&) = delete;
  SignalEvents& operator=(const SignalEvents&) = delete;

  /** Readable when a signal has arrived. */
  [[nodiscard]] int fd() const { return fd_.get(); }

  /** Takes a signal; false when none has arrived. */
  [[nodiscard]] bool take() const;

 private:
  FileDescriptor fd_;
};

/** What follows when a program ends that was ready. */
enum class AtEnd {
  stop_all,
  restart,          /**< and stop all when it keeps ending */
  restart_or_leave, /**< and go on without it when it keeps ending */
};

/** A program and what its end means. */
struct Supervised {
  Program program;
  AtEnd at_end = AtEnd::stop_all;
  std::chrono::seconds longest_end{3}; /**< from the request to end until it is killed */
};

/** Starts programs, passes on what they say, starts some of them again, and stops all when one that must live
 * ends. */
class Supervisor {
 public:
  /**
   * Output of the children, prefixed with their names, and what happens to them goes to `output`. Only a line
   * "first login: USER PASSWORD" stays as it is, for scripts.
   */
  Supervisor(std::vector<Supervised> programs, const SignalEvents& signals, std::ostream& output);

  /**
   * Runs until a signal asks to stop, a program without restarts ends, or one that is needed ends too often.
   * A program that was ready and gives no sign of life for as long as its watchdog says is killed, and its
   * end judged as any.
   *
   * @param when_ready called when all programs are ready, and again after each restart.
   * @return nothing after a signal, the failure otherwise. No child is left in either case.
   */
  Result<void> run(const std::function<void()>& when_ready);

  /** User and password that a program has offered for the first login since this was last called; empty when
   * there were none. */
  [[nodiscard]] std::string take_first_login() { return std::exchange(first_login_, {}); }

 private:
  using Clock = std::chrono::steady_clock;
  using Deadline = std::optional<Clock::time_point>;

  struct Task {
    Supervised supervised;
    RestartBudget budget;
    std::optional<ChildProcess> child = std::nullopt;
    bool ready = false;                              /**< the running child has said so */
    bool was_ready = false;                          /**< this child or an earlier one has said so */
    bool left = false;                               /**< it kept ending, and is not started again */
    std::optional<Watchdog> watchdog = std::nullopt; /**< of a ready child with a watchdog */
    Deadline kill_at = std::nullopt; /**< for a child that has to be ready, or gone, by then */
  };

  struct StopAsked {};
  struct Ready {
    Task& task;
  };
  struct Ended {
    Task& task;
    int wait_status;
  };
  struct TimedOut {};
  using Event = std::variant<StopAsked, Ready, Ended, TimedOut>;

  Result<void> serve(const std::function<void()>& when_ready);
  Result<void> note_ready(Task& task, const std::function<void()>& when_ready);
  Result<void> start_next(const std::function<void()>& when_ready);
  Result<void> start(Task& task);
  Result<void> judge_end(const Ended& ended, const std::function<void()>& when_ready);
  Deadline next_check() const;
  void check_times();
  void stop(Task& task);

  Event next_event(Deadline deadline);
  void collect_events(Deadline deadline);
  void forward_output(Task& task, bool rest);

  const SignalEvents& signals_;
  std::vector<Task> tasks_;
  std::deque<Event> events_;
  std::string first_login_;
  std::ostream& output_;
};

}  // namespace interlock::cli
