#include "stop_clock.hpp"

#include <algorithm>
#include <limits>

#include "monitors.h"

namespace interlock::campaign {
namespace {

bool is_past(std::uint32_t tick, std::uint32_t deadline) {
  return tick - deadline <= std::uint32_t{std::numeric_limits<std::int32_t>::max()};
}

}  // namespace

bool is_zero_drive(const ilk_outputs_t& outputs) noexcept {
  return std::ranges::all_of(outputs.frame, [](const auto& frame) { return judge_is_zero_drive(frame); });
}

bool StopClock::demand(std::uint32_t deadline, int axis, std::string_view reason) noexcept {
  const auto free = std::ranges::find(demands_, false, &Demand::open);
  if (free == demands_.end()) {
    return false;
  }
  *free = {true, deadline, axis, reason};
  open_++;
  return true;
}

std::uint32_t StopClock::step(std::uint32_t tick, const ilk_outputs_t& sent) noexcept {
  if (open_ == 0) {
    return 0;
  }
  std::uint32_t late = 0;
  for (Demand& demand : demands_) {
    if (!demand.open) {
      continue;
    }
    const bool is_zero = demand.axis == kNoAxis
                             ? is_zero_drive(sent)
                             : judge_is_zero_drive(sent.frame[static_cast<std::size_t>(demand.axis)]);
    if (is_zero) {
      met_++;
    } else if (is_past(tick, demand.deadline)) {
      late++;
      latest_ = demand.reason;
    } else {
      continue;
    }
    demand.open = false;
    open_--;
  }
  return late;
}

}  // namespace interlock::campaign
