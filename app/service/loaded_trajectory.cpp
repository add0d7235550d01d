#include "service/loaded_trajectory.hpp"

namespace interlock {

using nlohmann::json;

json to_json(const LoadedTrajectory& loaded) {
  if (loaded.program == nullptr) {
    return {
        {"rows", 0}, {"duration_s", 0.0}, {"axes", json::array()}, {"author", nullptr}, {"loaded", nullptr}};
  }
  const TimedTrajectory& trajectory = std::get<TimedLeg>(loaded.program->legs.front()).trajectory;
  json axes = json::array();
  for (const TrajectoryAxis& axis : trajectory.axes()) {
    axes.push_back({{"slot", axis.slot},
                    {"name", axis.name},
                    {"unit", unit_name(axis.unit)},
                    {"lowest", axis.reach.lowest},
                    {"highest", axis.reach.highest},
                    {"top_speed", axis.top_speed}});
  }
  return {{"rows", trajectory.rows()},
          {"duration_s", trajectory.duration_s()},
          {"axes", std::move(axes)},
          {"author", loaded.author},
          {"loaded", iso_8601(loaded.loaded)}};
}

VelocityLimits velocity_limits(const Robot& robot) {
  VelocityLimits limits;
  for (const Axis& axis : robot.axes) {
    if (axis.motion) {
      limits.emplace(axis.name, axis.motion->in_units(axis.counts_per_unit).velocity);
    }
  }
  return limits;
}

}  // namespace interlock
