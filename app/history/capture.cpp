#include "history/capture.hpp"

#include <vector>

#include "recorder/full_rate.hpp"

namespace interlock {
namespace {

using nlohmann::json;
using recorder::AxisTick;

constexpr double ns_per_us = 1e3;

template <typename Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

/** In each tick, of the readings of the last 20 ms; null until they cover half of that, and without a frame.
 */
json velocities(const VelocityRules& rules, const std::vector<AxisTick>& ticks) {
  VelocityEstimator estimator(rules);
  json velocity = json::array();
  for (const AxisTick& each : ticks) {
    std::optional<VelocityEstimate> estimate;
    if (each.position_counts) {
      estimator.add(*each.position_counts, each.card_time_us);
      estimate = estimator.estimate();
    }
    velocity.push_back(estimate ? json(estimate->counts_per_s) : json(nullptr));
  }
  return velocity;
}

json forces_json(const CapturedForces& forces, const std::vector<AxisTick>& ticks) {
  const auto of = [&](std::uint32_t adc, const ForceScale& scale) {
    json force = json::array();
    for (const AxisTick& each : ticks) {
      force.push_back(each.analog ? json(scale.force_n(analog_reading(*each.analog, adc))) : json(nullptr));
    }
    return force;
  };
  return {{"hand_n", of(forces.inputs.hand_adc, forces.scales.hand)},
          {"needle_n", of(forces.inputs.needle_adc, forces.scales.needle)}};
}

json capture_json(const CaptureSpan& span, std::uint32_t period_us, const std::vector<AxisTick>& ticks) {
  json tick = json::array();
  json begun_us = json::array();
  json position = json::array();
  json setpoint = json::array();
  json drive = json::array();
  for (const AxisTick& each : ticks) {
    tick.push_back(each.tick);
    begun_us.push_back(static_cast<double>(each.begun_ns - ticks.front().begun_ns) / ns_per_us);
    position.push_back(or_null(each.position_counts));
    setpoint.push_back(or_null(each.setpoint_counts));
    drive.push_back(each.drive);
  }
  return {{"slot", span.slot},
          {"period_us", period_us},
          {"tick", std::move(tick)},
          {"begun_us", std::move(begun_us)},
          {"position_counts", std::move(position)},
          {"setpoint_counts", std::move(setpoint)},
          {"velocity_counts_per_s", velocities(span.velocity, ticks)},
          {"drive", std::move(drive)},
          {"forces", span.forces ? forces_json(*span.forces, ticks) : json(nullptr)}};
}

}  // namespace

tl::expected<json, std::string> capture(const std::filesystem::path& black_box, const CaptureSpan& span) {
  return recorder::Ring::connect(black_box).map([&](const recorder::Ring& ring) {
    const auto sensor = span.forces ? std::optional(span.forces->inputs.slot) : std::nullopt;
    return capture_json(span, ring.run().config.common.period_us,
                        recorder::full_rate(ring, {span.slot, span.seconds, span.until, sensor}));
  });
}

}  // namespace interlock
