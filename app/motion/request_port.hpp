/**
 * @file
 * Sends requests within the kernel's budget for a tick and remembers who waits for which verdict.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>

#include "link/link_client.hpp"
#include "motion/kernel_request.hpp"

namespace interlock {

/** What of a `KernelCall` is still of interest when its verdict comes. */
struct CallOrigin {
  std::uint32_t call_id = 0;
  std::uint32_t kind = 0; /**< ilk_request_kind_t */
  std::uint32_t slot = 0;
};

/** Number of the newest STOP that the request stands for. */
struct StopOrigin {
  std::uint32_t stops = 0;
};

/** The app's heartbeat, which no task sent. */
struct HeartbeatOrigin {};

/** Who sent a request. */
using RequestOrigin = std::variant<HeartbeatOrigin, ModeOrigin, CallOrigin, StopOrigin>;

/** Sends requests by the link and remembers who sent each, until its verdict comes. */
class RequestPort {
 public:
  explicit RequestPort(LinkClient& link) noexcept : link_(link) {}

  /** Opens the budget of a new tick: ILK_REQUESTS_PER_TICK requests. */
  void begin_tick() noexcept { left_ = ILK_REQUESTS_PER_TICK; }

  /** False when this tick's budget is used up or the ring is full. */
  bool send(const ilk_request_t& request, const RequestOrigin& origin) noexcept;

  /** Who sent the request of that number; empty when it is not, or no longer, waited for. */
  [[nodiscard]] std::optional<RequestOrigin> settle(std::uint32_t sequence) noexcept;

  /** Forgets every request in flight and hands each to `lost(origin)`. */
  template <typename Lost>
  void forget_all(Lost&& lost) noexcept {
    for (Flight& flight : flights_) {
      if (flight.sequence != 0) {
        lost(flight.origin);
        flight = Flight{};
      }
    }
  }

 private:
  /**
   * Twice the records of the ring, since verdicts come back later than the ring is read. A request whose
   * verdict is still missing so much later has lost it; its place is taken by a newer one.
   */
  static constexpr std::size_t flights = 2 * ILK_LINK_REQUESTS;

  struct Flight {
    std::uint32_t sequence = 0; /**< 0: free */
    RequestOrigin origin;
  };

  LinkClient& link_;
  std::uint32_t left_ = 0;
  std::array<Flight, flights> flights_{};
};

}  // namespace interlock
