/**
 * @file
 * A thread that writes for others, so that they never wait for a disk, a pipe or a terminal.
 */
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

namespace interlock {

/**
 * Does jobs in the order in which they come. What comes while the queue is full is not done but counted,
 * until the queue is half empty: one gap with one count, told once, in place of many. Any thread may use it.
 */
class WritingThread {
 public:
  /** Something to write. */
  using Job = std::function<void()>;
  /** By which waiting is limited. */
  using Clock = std::chrono::steady_clock;

  /** Jobs that may wait: a second of the worst flood of lines, and a few megabytes. */
  static constexpr std::size_t capacity = 4096;

  /** A job that throws is counted as lost, too. `tell_lost` runs in the thread, in the place of the gap. */
  explicit WritingThread(std::function<void(std::uint64_t)> tell_lost);

  /** Ends the thread. Jobs that wait are not done: `wait_until_done` comes before. A thread that hangs in its
   * job is left to itself, with all that the job owns. */
  ~WritingThread();

  WritingThread(const WritingThread&) = delete;
  WritingThread& operator=(const WritingThread&) = delete;

  /** Never waits. */
  void add(Job job);

  /** Whether all jobs are done, then if not now. */
  bool wait_until_done(Clock::time_point then) const;

  /** Jobs that were not done, ever. */
  [[nodiscard]] std::uint64_t lost() const;

 private:
  struct State;
  static void work(State& state);

  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace interlock
