#include "service/loaded_trajectory.hpp"

namespace interlock {

using nlohmann::json;

json to_json(const LoadedTrajectory& loaded) {
  if (loaded.program == nullptr) {
    return {{"rows", 0},         {"duration_s", 0.0}, {"slowed_by", 1.0}, {"axes", json::array()},
            {"author", nullptr}, {"loaded", nullptr}};
  }
  const TimedTrajectory& trajectory = std::get<TimedLeg>(loaded.program->legs.front()).trajectory;
  json axes = json::array();
  for (const TrajectoryAxis& axis : trajectory.axes()) {
    axes.push_back({{"slot", axis.slot},
                    {"name", axis.name},
                    {"unit", unit_name(axis.unit)},
                    {"lowest", axis.reach.lowest},
                    {"highest", axis.reach.highest},
                    {"top_speed", axis.top.velocity},
                    {"top_acceleration", axis.top.acceleration},
                    {"top_jerk", axis.top.jerk}});
  }
  return {{"rows", trajectory.rows()},
          {"duration_s", trajectory.duration_s()},
          {"slowed_by", trajectory.slowed_by()},
          {"axes", std::move(axes)},
          {"author", loaded.author},
          {"loaded", iso_8601(loaded.loaded)}};
}

}  // namespace interlock
