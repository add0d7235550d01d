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

json capture_json(std::uint32_t slot, std::uint32_t period_us, const std::vector<AxisTick>& ticks) {
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
  return {{"slot", slot},
          {"period_us", period_us},
          {"tick", std::move(tick)},
          {"begun_us", std::move(begun_us)},
          {"position_counts", std::move(position)},
          {"setpoint_counts", std::move(setpoint)},
          {"drive", std::move(drive)}};
}

}  // namespace

tl::expected<json, std::string> capture(const std::filesystem::path& black_box, const CaptureSpan& span) {
  return recorder::Ring::open(black_box).map([&](const recorder::Ring& ring) {
    return capture_json(span.slot, ring.run().config.period_us,
                        recorder::full_rate(ring, {span.slot, span.seconds, span.until}));
  });
}

}  // namespace interlock
