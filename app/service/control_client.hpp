/**
 * @file
 * The network thread's end of the channel to the control thread.
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "motion/realtime_channel.hpp"
#include "system/utc_time.hpp"

namespace interlock {

class ControlClient {
 public:
  ControlClient(const boost::asio::any_io_executor& executor, RealtimeChannel& channel);

  /** What the control thread saw last. The reference holds until the next call. */
  [[nodiscard]] const ControlView& view();

  /** Since when this kernel is connected; nothing without one. */
  [[nodiscard]] const std::optional<UtcTime>& since() const { return since_; }

  /** The view that `view` gave last. */
  [[nodiscard]] const ControlView& current() const { return channel_.view.current(); }

  /** STOPs and changes of who is in control so far. */
  [[nodiscard]] std::uint32_t stops() const { return channel_.stops.load(std::memory_order_relaxed); }

  /** People are served still: to be said at least every 100 ms, else motion ends. */
  void say_served() { channel_.served.fetch_add(1, std::memory_order_relaxed); }

  /** Hands over a command, marked as newer than every STOP so far, and a hold as begun or renewed now; false
   * when the queue is full. */
  bool send(Command command);

  /** What holds motion still from outside, in place of what was set before. */
  void set_holds(const OutsideHolds& holds) {
    channel_.holds.writing() = holds;
    channel_.holds.publish();
  }

  /** Sends one request to the kernel, a RESTORE with its position; empty when no verdict came within a
   * second, without verdict when a STOP overtook it.
   */
  boost::asio::awaitable<std::optional<KernelResponse>> ask(std::uint32_t kind, std::uint32_t slot,
                                                            std::int32_t target_counts = 0);

  /** Stops, whatever else waits, before this returns. What is returned waits for the answer: empty when no
   * kernel is connected or none answered within 300 ms. */
  boost::asio::awaitable<std::optional<StopAnswer>> stop();

  /** As `stop`, by somebody who sees the kernel's answer otherwise. */
  void stop_unanswered() { channel_.stop(); }

  /** Ends MOTION, whatever else waits, and leaves every order open: it goes on when the pedal was released
   * and is pressed again. */
  void pause() { channel_.pauses.fetch_add(1, std::memory_order_release); }

  /**
   * Tells the kernel that control changed hands; `holder` is the number of the new hold, 0: nobody's. It is a
   * STOP, too: no order that was given before starts or goes on.
   */
  void change_holder(std::uint32_t number);

  /** Told of each kernel event, and of each lot of events that was lost. */
  std::function<void(const ilk_event_t&)> on_event = [](const ilk_event_t&) {};
  std::function<void(const EventsLost&)> on_events_lost = [](const EventsLost&) {};
  /** Told that orders may have changed. */
  std::function<void()> on_orders = [] {};

  /** Serves until the io_context stops. */
  boost::asio::awaitable<void> listen();

 private:
  template <typename Result>
  struct Waiter {
    std::optional<Result> result;
    boost::asio::steady_timer timer;
  };

  void take(const Notice& notice);
  boost::asio::awaitable<std::optional<StopAnswer>> stop_answered(std::uint32_t number);

  boost::asio::any_io_executor executor_;
  RealtimeChannel& channel_;
  boost::asio::posix::stream_descriptor wake_;
  std::optional<UtcTime> since_;
  std::uint32_t generation_ = 0; /**< of the kernel's link, at `since_` */
  std::uint32_t last_call_id_ = 0;
  std::map<std::uint32_t, Waiter<KernelResponse>*> calls_;
  std::multimap<std::uint32_t, Waiter<StopAnswer>*> stops_;
};

}  // namespace interlock
