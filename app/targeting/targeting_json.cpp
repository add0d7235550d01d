#include "targeting/targeting_json.hpp"

#include <numbers>

namespace interlock {

using nlohmann::json;

namespace {

json list_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

/** Column by column. */
json list_of(const Eigen::Matrix3d& matrix) {
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

json to_json(const ErrorEllipsoid& ellipsoid) {
  return {{"centre_mm", list_of(ellipsoid.centre_mm)},
          {"half_axes_mm", list_of(ellipsoid.half_axes_mm)},
          {"directions", list_of(ellipsoid.directions)},
          {"covariance_mm2", list_of(ellipsoid.covariance_mm2)}};
}

}  // namespace

json to_json(const KinematicsError& error) {
  // No range is the reason where there is no kinematics.
  const bool has_range = error.code != KinematicsError::Code::absent;
  return {{"code", code_name(error.code)},
          {"text", error.message()},
          {"quantity", error.quantity},
          {"value", error.value ? json(*error.value) : json()},
          {"lowest", has_range ? json(error.lowest) : json()},
          {"highest", has_range ? json(error.highest) : json()}};
}

json to_json(const Deviation& deviation) {
  return {{"offset_mm", list_of(deviation.offset_mm)},
          {"distance_mm", deviation.distance_mm},
          {"angle_deg", deviation.angle_rad * 180.0 / std::numbers::pi}};
}

void add_error_budget(json& body, const KinematicsResult<ErrorBudget>& budget) {
  body["error_budget"] = nullptr;
  body["error_budget_problem"] = nullptr;
  if (!budget) {
    body["error_budget_problem"] = to_json(budget.error());
    return;
  }
  auto contributions = json::array();
  for (const auto& [source, treatment_mm, tip_mm, not_stated] : budget->contributions) {
    contributions.push_back({{"source", source},
                             {"treatment_mm", treatment_mm},
                             {"tip_mm", tip_mm},
                             {"not_stated", not_stated.empty() ? json() : json(not_stated)}});
  }
  body["error_budget"] = {{"treatment", to_json(budget->treatment)},
                          {"tip", to_json(budget->tip)},
                          {"contributions", std::move(contributions)}};
}

json to_json(const Robot& robot, const Alignment& alignment) {
  json setpoints = json::object();
  json clamped = json::array();
  for (const AxisSetpoint& setpoint : alignment.setpoints) {
    const Axis& axis = *robot.at_slot(setpoint.slot);
    setpoints[axis.name] = {{"counts", setpoint.counts}, {"position", axis.to_unit(setpoint.counts)}};
    if (setpoint.clamped) {
      clamped.push_back(axis.name);
    }
  }
  const auto& length = alignment.cannula_length_mm;
  json body{{"desired", row_major(alignment.desired)},
            {"reachable", row_major(alignment.reachable)},
            {"reachable_tip", list_of(alignment.reachable_tip)},
            {"setpoints", setpoints},
            {"clamped", clamped},
            {"deviation", to_json(alignment.deviation)},
            {"within_tolerance",
             is_tolerable(alignment.deviation, robot.targeting.tolerance_mm, robot.targeting.tolerance_deg)},
            {"cannula_length_mm", length ? json(*length) : json()}};
  add_error_budget(body, alignment.error_budget);
  return body;
}

}  // namespace interlock
