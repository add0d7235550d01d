/**
 * @file
 * Requests of a mode: what is to be sent to the kernel in this tick.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interlock/types.h"

namespace interlock {

/** The task that a request serves. */
struct ModeOrigin {
  std::uint32_t kind = ILK_REQUEST_MOVE; /**< ilk_request_kind_t: MOVE, HOME or STOP */
  std::uint32_t slot = 0;
  std::uint32_t task = 0;

  bool operator==(const ModeOrigin&) const = default;
};

/** One request that a mode wants sent. */
struct KernelRequest {
  ModeOrigin origin;
  std::int32_t target_counts = 0; /**< MOVE only, as the rest */
  std::uint32_t drive = 0;
  std::uint32_t amplitude = 0;
  std::uint32_t lease_ticks = 0;
};

/** That request as it is sent, with the number of the press of the pedal that its mode saw. */
inline ilk_request_t sent_form(const KernelRequest& request, std::uint32_t consent) noexcept {
  ilk_request_t sent{};
  sent.kind = request.origin.kind;
  sent.axis = request.origin.slot;
  sent.target_counts = request.target_counts;
  sent.drive = request.drive;
  sent.amplitude = request.amplitude;
  sent.lease_ticks = request.lease_ticks;
  sent.consent = consent;
  return sent;
}

/** The requests of a tick, in the order in which they are to be sent: at most two an axis, and a STOP. */
class KernelRequests {
 public:
  static constexpr std::size_t capacity = 2 * ILK_SLOTS + 1;

  /** Appends a request; beyond the capacity it is dropped. */
  void add(const KernelRequest& request) noexcept {
    if (count_ < capacity) {
      requests_[count_++] = request;
    }
  }

  [[nodiscard]] std::span<const KernelRequest> all() const noexcept { return {requests_.data(), count_}; }

 private:
  std::array<KernelRequest, capacity> requests_{};
  std::size_t count_ = 0;
};

}  // namespace interlock
