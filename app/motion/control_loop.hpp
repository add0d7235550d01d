/**
 * @file
 * The control thread: paced by the kernel's snapshots, it keeps the app alive in the kernel's eyes, runs the
 * modes and carries requests and verdicts.
 *
 * Each tick is the list of named steps in `tick`. None allocates, locks, logs or throws; only attaching,
 * while nothing can move, may log.
 */
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>

#include "link/link_client.hpp"
#include "motion/deadman_timer.hpp"
#include "motion/mode_manager.hpp"
#include "motion/realtime_channel.hpp"
#include "motion/request_port.hpp"
#include "motion/tick_observer.hpp"

namespace interlock {

/** What the link is for. */
enum class LinkUse {
  control,
  replay, /**< a recording comes over it: nothing is sent, not even a sign of life */
};

/** The thread between link and network. Everything but `rounds` belongs to it. */
class ControlLoop {
 public:
  /** @param observer shown each tick; it must outlive the loop */
  ControlLoop(std::string link_socket, Modes modes, LinkageWatch linkages, RealtimeChannel& channel,
              TickObserver* observer = nullptr, LinkUse use = LinkUse::control);

  /** Serves until stopped, attaching again and again. On leaving it asks the kernel to end MOTION, unless it
   * only watches. */
  void run(const std::stop_token& stop) noexcept;

  /** How often the loop has gone round, with a kernel or without one; wraps. For any thread. */
  [[nodiscard]] std::uint32_t rounds() const noexcept { return rounds_.load(std::memory_order_relaxed); }

 private:
  void attach_or_back_off(const std::stop_token& stop) noexcept;
  void lose_link() noexcept;

  void tick() noexcept;
  void control() noexcept;
  void watch() noexcept;
  void miss_tick() noexcept;
  void watch_service() noexcept;
  void obey_stop() noexcept;
  void obey_pause() noexcept;
  void obey_holds() noexcept;
  void read_events() noexcept;
  void dispatch_verdict(const ilk_event_t& event) noexcept;
  void send_heartbeat() noexcept;
  void take_commands() noexcept;
  [[nodiscard]] bool take(const Approval& approval) noexcept;
  [[nodiscard]] bool take(const Renewal& renewal) noexcept;
  [[nodiscard]] bool take(const SeenImage& seen) noexcept;
  [[nodiscard]] bool take(const Confirmation& confirmation) noexcept;
  [[nodiscard]] bool take(const Cancel& cancel) noexcept;
  [[nodiscard]] bool take(const KernelCall& call) noexcept;
  [[nodiscard]] std::int32_t newer_than_stop(std::uint32_t stops) const noexcept;
  void lose_verdict(const RequestOrigin& origin) noexcept;
  void end_let_go() noexcept;
  void send_requests() noexcept;
  void publish() noexcept;

  void refuse_commands() noexcept;
  void answer(const StopAnswer& answer) noexcept;
  void answer_lost(const RequestOrigin& origin) noexcept;
  [[nodiscard]] bool room_for_events() const noexcept;
  void notify(const Notice& notice) noexcept;

  /** A count that another thread keeps going. */
  struct Sign {
    std::uint32_t seen = 0;
    std::chrono::nanoseconds still{0}; /**< for which it has not changed */
  };

  /** The newest jog of an axis. */
  struct Jog {
    std::uint32_t task = 0;
    DeadmanTimer lease{jog_timeout};
  };

  LinkClient link_;
  RequestPort port_{link_};
  ModeManager modes_;
  RealtimeChannel& channel_;
  TickObserver* observer_;
  LinkUse use_;
  ControlView view_;
  TaskTable published_tasks_;
  BiopsyFindings published_biopsy_;
  std::string attach_complaint_;
  std::chrono::milliseconds back_off_;
  std::uint32_t heartbeat_tick_ = 0;
  std::uint32_t holder_sent_ = 0;
  std::uint32_t stops_seen_ = 0;
  std::uint32_t stops_sent_ = 0;
  std::uint32_t pauses_sent_ = 0;
  std::array<Jog, ILK_SLOTS> jogs_{};
  Sign network_;
  Sign door_;
  std::chrono::steady_clock::time_point round_; /**< begin of the last round that watched */
  std::uint32_t events_lost_ = 0;               /**< by the link, as last seen */
  std::uint32_t events_dropped_ = 0;            /**< of which the network was not told yet */
  bool heartbeat_sent_ = false;
  bool noticed_ = false;
  StandStill still_;
  bool nobody_served_ = false;
  std::atomic<std::uint32_t> rounds_ = 0;
};

}  // namespace interlock
