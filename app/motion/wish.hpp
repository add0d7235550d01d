/**
 * @file
 * Wishes of a mode: the requests that it wants sent in this tick.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interlock/types.h"

namespace interlock {

/** The task that a request serves. */
struct WishOrigin {
  std::uint32_t kind = ILK_REQUEST_MOVE; /**< ilk_request_kind_t: MOVE, HOME or STOP */
  std::uint32_t slot = 0;
  std::uint32_t task = 0;

  bool operator==(const WishOrigin&) const = default;
};

/** One request that a mode wants sent. */
struct Wish {
  WishOrigin origin;
  std::int32_t target_counts = 0; /**< MOVE only, as the rest */
  std::uint32_t drive = 0;
  std::uint32_t amplitude = 0;
  std::uint32_t lease_ticks = 0;
};

/** The request to send for a wish, with the number of the press of the pedal that its mode saw. */
inline ilk_request_t request_of(const Wish& wish, std::uint32_t consent) noexcept {
  ilk_request_t request{};
  request.kind = wish.origin.kind;
  request.axis = wish.origin.slot;
  request.target_counts = wish.target_counts;
  request.drive = wish.drive;
  request.amplitude = wish.amplitude;
  request.lease_ticks = wish.lease_ticks;
  request.consent = consent;
  return request;
}

/** The wishes of a tick, in the order in which they are to be sent: at most two an axis, and a STOP. */
class Wishes {
 public:
  static constexpr std::size_t capacity = 2 * ILK_SLOTS + 1;

  /** Appends a wish; beyond the capacity it is dropped. */
  void add(const Wish& wish) noexcept {
    if (count_ < capacity) {
      wishes_[count_++] = wish;
    }
  }

  [[nodiscard]] std::span<const Wish> all() const noexcept { return {wishes_.data(), count_}; }

 private:
  std::array<Wish, capacity> wishes_{};
  std::size_t count_ = 0;
};

}  // namespace interlock
