#include "history/history.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace interlock {
namespace {

using nlohmann::json;
using Buckets = std::span<const TickBucket* const>;

/** The columns of a quantity; null where it was not there. */
template <typename Quantity, typename Shown>
json columns(Buckets buckets, Quantity quantity, Shown shown) {
  json least = json::array();
  json greatest = json::array();
  for (const TickBucket* bucket : buckets) {
    const auto& extremes = quantity(*bucket);
    least.push_back(extremes.known() ? shown(extremes.least()) : json(nullptr));
    greatest.push_back(extremes.known() ? shown(extremes.greatest()) : json(nullptr));
  }
  return {{"least", std::move(least)}, {"greatest", std::move(greatest)}};
}

template <typename Quantity>
json columns(Buckets buckets, Quantity quantity) {
  return columns(buckets, quantity, [](auto value) { return json(value); });
}

json axis_json(std::uint32_t slot, Buckets buckets) {
  const auto of = [&](auto quantity) {
    return columns(buckets, [&](const TickBucket& bucket) { return bucket.axis[slot].*quantity; });
  };
  return {{"slot", slot},
          {"position_counts", of(&AxisExtremes::position_counts)},
          {"setpoint_counts", of(&AxisExtremes::setpoint_counts)},
          {"error_counts", of(&AxisExtremes::error_counts)},
          {"velocity_counts_per_s", of(&AxisExtremes::velocity_counts_per_s)},
          {"drive", of(&AxisExtremes::drive)}};
}

json forces_json(const ForceScales& forces, Buckets buckets) {
  const auto in_newtons = [](const ForceScale& scale) {
    return [&scale](std::uint32_t counts) { return json(scale.force_n(counts)); };
  };
  return {{"hand_n", columns(
                         buckets, [](const TickBucket& bucket) { return bucket.hand_counts; },
                         in_newtons(forces.hand))},
          {"needle_n", columns(
                           buckets, [](const TickBucket& bucket) { return bucket.needle_counts; },
                           in_newtons(forces.needle))}};
}

}  // namespace

void History::add(const TickBucket& bucket) {
  if (buckets_.size() == capacity) {
    buckets_.pop_front();
  }
  buckets_.push_back(bucket);
  ++newest_;
}

json History::after(std::uint64_t after, const Robot& robot, const std::optional<ForceScales>& forces) const {
  const std::uint64_t oldest = newest_ - buckets_.size() + 1;
  // A number that was not given yet is of another run of the app.
  const std::uint64_t first = after > newest_ ? oldest : std::max(after + 1, oldest);
  const std::uint64_t count = std::min<std::uint64_t>(newest_ + 1 - first, most_of_an_answer);
  std::vector<const TickBucket*> chosen;
  json runs = json::array();
  json last_ticks = json::array();
  json ticks = json::array();
  for (std::uint64_t number = first; number < first + count; ++number) {
    const TickBucket& bucket = buckets_[static_cast<std::size_t>(number - oldest)];
    chosen.push_back(&bucket);
    runs.push_back(bucket.run);
    last_ticks.push_back(bucket.last_tick);
    ticks.push_back(bucket.ticks);
  }
  json axes = json::array();
  for (const Axis& axis : robot.axes) {
    axes.push_back(axis_json(axis.slot, chosen));
  }
  return {{"app_begun_s", begun_s_},
          {"period_us", robot.period_us},
          {"ticks_of_bucket", ticks_of_bucket(robot.period_us)},
          {"first", first},
          {"next", first + count - 1},
          {"more", first + count <= newest_},
          {"run", std::move(runs)},
          {"last_tick", std::move(last_ticks)},
          {"ticks", std::move(ticks)},
          {"axes", std::move(axes)},
          {"forces", forces ? forces_json(*forces, chosen) : json(nullptr)}};
}

}  // namespace interlock
