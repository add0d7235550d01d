#include "oracle/rules.hpp"

#include <algorithm>

namespace interlock::oracle {
namespace {

/** The hard maxima of the specification, in microseconds where they are times. */
constexpr std::uint64_t kMaxAppTimeoutUs = 150'000;
constexpr std::uint64_t kMaxLeaseUs = 150'000;
constexpr std::uint64_t kMaxDebounceUs = 50'000;
constexpr std::uint64_t kMaxDisagreeUs = 50'000;
constexpr std::uint64_t kMaxStallUs = 500'000;
constexpr std::uint32_t kMaxBadFrames = 5;
constexpr std::uint32_t kMaxOverruns = 10;
constexpr std::int64_t kUnhomedShare = 10; /**< unhomed drive and travel are at most one part in so many */

bool is_within(std::uint32_t ticks, std::uint32_t period_us, std::uint64_t maximum_us) {
  return ticks > 0 && std::uint64_t{ticks} * period_us <= maximum_us;
}

bool is_permitted(const AxisRules& axis, std::uint32_t period_us) {
  const std::int64_t range = std::int64_t{axis.soft_max} - axis.soft_min;
  const std::int64_t coast = axis.coast;
  return coast > 0 && axis.soft_min + coast < axis.soft_max - coast && axis.max_drive > 0 &&
         axis.unhomed_max_drive > 0 && axis.unhomed_max_drive <= axis.max_drive / kUnhomedShare &&
         axis.unhomed_travel > 0 && axis.unhomed_travel * kUnhomedShare <= range && axis.reverse >= coast &&
         axis.drift >= coast && is_within(axis.stall_ticks, period_us, kMaxStallUs);
}

}  // namespace

bool are_permitted(const SystemRules& rules) noexcept {
  const std::uint32_t period = rules.period_us;
  return is_within(rules.app_timeout_ticks, period, kMaxAppTimeoutUs) &&
         is_within(rules.lease_max_ticks, period, kMaxLeaseUs) &&
         is_within(rules.pedal_debounce_ticks, period, kMaxDebounceUs) &&
         is_within(rules.pedal_disagree_ticks, period, kMaxDisagreeUs) && rules.bad_frame_limit > 0 &&
         rules.bad_frame_limit <= kMaxBadFrames && rules.overrun_limit > 0 &&
         rules.overrun_limit <= kMaxOverruns &&
         std::ranges::all_of(rules.axes, [period](const AxisRules& axis) {
           return !has_axis(axis.card) || is_permitted(axis, period);
         });
}

}  // namespace interlock::oracle
