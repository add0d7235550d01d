/**
 * @file
 * Everything that passes between the network thread and the control thread.
 *
 * Lock-free on both sides, so that no load of the network can hold up the control tick: bounded
 * single-producer single-consumer queues for what must arrive in order, a triple buffer for the newest view,
 * and counters for STOP and pause, which therefore never stand in a queue behind anything.
 */
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>

#include "interlock/link.h"
#include "interlock/sim_bus.h"
#include "motion/biopsy_run.hpp"
#include "motion/force_watch.hpp"
#include "motion/outside_holds.hpp"
#include "motion/task.hpp"
#include "system/file_descriptor.hpp"

namespace interlock {

// Hands the newest value from one writing thread to one reading thread. Neither ever waits for the other.

/**
 * Three copies: one that the writer fills, one that the reader looks at, and one in between, which holds the
 * newest value. Each side swaps its own copy with the one in between.
 */
template <typename T>
class TripleBuffer {
 public:
  /** Writer only: the copy to fill. Its old content is undefined. */
  [[nodiscard]] T& writing() noexcept { return copies_[writing_]; }

  /** Writer only: makes the filled copy the newest. */
  void publish() noexcept {
    const std::uint32_t before = between_.exchange(writing_ | fresh, std::memory_order_acq_rel);
    writing_ = before & index;
  }

  /** Reader only: the value that `newest` gave last. */
  [[nodiscard]] const T& current() const noexcept { return copies_[reading_]; }

  /** Reader only: the newest value; the reference holds until the next call. */
  [[nodiscard]] const T& newest() noexcept {
    if ((between_.load(std::memory_order_relaxed) & fresh) != 0) {
      const std::uint32_t before = between_.exchange(reading_, std::memory_order_acq_rel);
      reading_ = before & index;
    }
    return copies_[reading_];
  }

 private:
  static constexpr std::uint32_t index = 3;
  static constexpr std::uint32_t fresh = 4;

  std::array<T, 3> copies_{};
  std::uint32_t writing_ = 0;
  std::uint32_t reading_ = 1;
  std::atomic<std::uint32_t> between_{2};
};

// Wakes a thread that sleeps in poll or in an event loop: an eventfd.

/** Signals coalesce: many before a look are one. */
class WakeSignal {
 public:
  /** `descriptor()` is negative when the system has no descriptor left. */
  WakeSignal() noexcept;

  /** Never blocks, never fails. */
  void signal() const noexcept;

  /** Takes the signals that came. */
  void clear() const noexcept;

  /** Readable while a signal is there. */
  [[nodiscard]] int descriptor() const noexcept { return event_.get(); }

 private:
  FileDescriptor event_;
};

// Everything that passes between the network thread and the control thread.
//
// Lock-free on both sides, so that no load of the network can hold up the control tick: bounded
// single-producer single-consumer queues for what must arrive in order, a triple buffer for the newest view,
// and counters for STOP and pause, which therefore never stand in a queue behind anything.

/** Ends a task. */
struct Cancel {
  std::uint32_t task = 0;
};

/** Passes one request to the kernel and brings back its verdict. */
struct KernelCall {
  std::uint32_t call_id = 0; /**< by which the asker knows the answer */
  std::uint32_t kind = 0;    /**< ilk_request_kind_t, none of HEARTBEAT, STOP, MOVE and HOME */
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;                 /**< position of a RESTORE */
  std::chrono::steady_clock::time_point deadline; /**< later than this nobody waits, so it is not sent */
  std::uint32_t stops = 0;                        /**< as in `Approval`; DISABLE is sent all the same */
};

/** Anything that the network threads ask of the control thread. */
using Command = std::variant<Approval, Confirmation, Renewal, SeenImage, Cancel, KernelCall>;

/** The kernel's word on a `KernelCall`; no verdict: it was not sent, or the answer got lost with the link.
 */
struct KernelResponse {
  std::uint32_t call_id = 0;
  std::optional<std::uint32_t> verdict;
  std::uint32_t tick = 0;
};

/** The kernel's word on every STOP up to number `stops`. */
struct StopAnswer {
  std::uint32_t stops = 0;
  std::optional<std::uint32_t> verdict;
  std::uint32_t tick = 0;
};

/** Kernel events that nobody could read in time. */
struct EventsLost {
  std::uint32_t count = 0;
};

/** Anything that the control thread tells. */
using Notice = std::variant<ilk_event_t, KernelResponse, StopAnswer, EventsLost>;

/** What the control thread sees, whole. */
struct ControlView {
  bool attached = false; /**< to a kernel that has published a snapshot */
  bool replay = false;   /**< a recording is shown, of which nothing can be asked */
  std::uint32_t generation = 0;
  std::chrono::steady_clock::time_point received; /**< when the snapshot was read */
  ilk_snapshot_t snapshot{};
  TaskTable tasks;
  SweepSpeeds sweep_speeds{};
  MeasuredAxis measured; /**< by the newest identification */
  BiopsyFindings biopsy;
  BiopsyNow biopsy_now;
  ForceReadings force; /**< of a robot with a needle */
  GateState gate = GateState::off;
  bool scanning = false; /**< everything is held still for a scan */

  /** This moment, by the clock that holds run on: the kernel's if that is simulated. */
  [[nodiscard]] Moment moment(std::chrono::steady_clock::time_point now) const noexcept {
    const bool simulated = attached && snapshot.clock == ILK_CLOCK_SIM;
    return {now, snapshot.state.system.tick, simulated ? snapshot.period_us : 0};
  }
};

/** Both queues, and what the control thread saw last. */
struct RealtimeChannel {
  static constexpr std::size_t command_capacity = 256;
  static constexpr std::size_t notice_capacity = 4096;

  boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<command_capacity>> commands;
  boost::lockfree::spsc_queue<Notice, boost::lockfree::capacity<notice_capacity>> notices;
  TripleBuffer<ControlView> view;
  TripleBuffer<OutsideHolds> holds;    /**< written by the network thread */
  std::atomic<std::uint32_t> stops{0}; /**< STOPs asked for since start */
  /** Count on for as long as people are served, by the network's thread and by that of its door: once one
   * stands still, motion ends. 0: not yet. */
  std::atomic<std::uint32_t> served{0};
  std::atomic<std::uint32_t> door_kept{0};
  /** Pauses asked for since start: each ends MOTION as the release of the pedal does, so that tasks stay
   * open and go on when somebody presses it again. */
  std::atomic<std::uint32_t> pauses{0};
  /** Number of the present hold of control; 0: nobody. Changed before the STOP that each change is. */
  std::atomic<std::uint32_t> holder{0};
  WakeSignal network_wake;          /**< a notice came or a task changed */
  TripleBuffer<StopAnswer> stopped; /**< the newest one, for the door */
  WakeSignal door_wake;             /**< it changed */
  /** When somebody last stopped the robot. */
  std::atomic<std::chrono::steady_clock::duration> last_stop{};

  /** A STOP, which stands in no queue; its number. For any thread. */
  std::uint32_t stop() noexcept {
    last_stop.store(std::chrono::steady_clock::now().time_since_epoch(), std::memory_order_relaxed);
    return stops.fetch_add(1, std::memory_order_release) + 1;
  }
};

}  // namespace interlock
