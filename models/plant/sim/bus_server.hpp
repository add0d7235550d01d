/**
 * @file
 * The kernel's end of the plant: one client, one answer to each exchange, and plant time by its clock.
 */
#ifndef INTERLOCK_PLANT_SIM_BUS_SERVER_HPP
#define INTERLOCK_PLANT_SIM_BUS_SERVER_HPP

#include <poll.h>

#include <chrono>
#include <span>
#include <vector>

#include "plant/plant.hpp"
#include "plant/sim/listener.hpp"

namespace interlock::plant::sim {

/**
 * Serves one kernel at a time; a second one is turned away.
 *
 * Plant time: stands still until the first kernel comes. With the simulated clock it moves by one period
 * with each exchange; with the real clock, and whenever the kernel is gone, it follows the wall clock, so
 * that the card watchdogs act on a dead kernel.
 */
class BusServer {
 public:
  BusServer(Listener listener, Plant& plant, std::uint32_t config_crc);

  /** Adds the descriptors to wait for. */
  void add_descriptors(std::vector<pollfd>& descriptors) const;

  /** Does what is due, without waiting; `ready` is what `add_descriptors` added, polled. */
  void serve(std::span<const pollfd> ready);

  /** Plant time passes by itself, so `serve` has to be called every millisecond or more often. */
  bool follows_wall_clock() const { return started_ && clock_ != ILK_CLOCK_SIM; }

  /** Clock of the attached kernel; nothing when none is attached. */
  std::optional<ilk_clock_t> clock() const { return clock_; }

 private:
  using WallClock = std::chrono::steady_clock;

  void follow_wall_clock();
  void serve_client();
  void answer_hello(const ilk_sim_hello_t& hello);
  void answer_exchange(const ilk_sim_exchange_t& exchange);
  bool send(const void* record, std::size_t bytes);
  void detach(const std::string& reason);
  void accept_client();

  Listener listener_;
  Plant& plant_;
  std::uint32_t config_crc_;
  FileDescriptor client_;
  std::optional<ilk_clock_t> clock_;
  bool started_ = false;
  WallClock::time_point wall_;
};

}  // namespace interlock::plant::sim

#endif
