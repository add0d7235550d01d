#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "proposals/profile.hpp"
#include "service/alignment_view.hpp"
#include "service/drafts.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** Digits beyond these would be paper, and a third of the answer. */
constexpr double per_count = 100.0;
constexpr double per_mm = 1000.0;
constexpr double per_s = 1e6;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

json rounded(const std::vector<double>& values, double per_unit) {
  json list = json::array();
  for (const double value : values) {
    list.push_back(rounded(value, per_unit));
  }
  return list;
}

json list_of(const Eigen::Vector3d& point) {
  return {rounded(point.x(), per_mm), rounded(point.y(), per_mm), rounded(point.z(), per_mm)};
}

json to_json(const CheckResult& result) {
  return {{"name", check_name(result.name)},
          {"words", check_words(result.name)},
          {"outcome", outcome_name(result.outcome)},
          {"code", result.code.empty() ? json() : json(result.code)}};
}

json to_json(const AxisProfile& profile) {
  return {{"slot", profile.slot},
          {"homed", profile.homed},
          {"lowest_setpoint_counts", profile.allowed.lowest_counts},
          {"highest_setpoint_counts", profile.allowed.highest_counts},
          {"soft_min_counts", profile.soft_limits.min_counts},
          {"soft_max_counts", profile.soft_limits.max_counts},
          {"velocity_limit_counts_per_s", profile.top_velocity ? json(*profile.top_velocity) : json()},
          {"drive_limit", profile.most_drive},
          {"lowest_counts", rounded(profile.lowest, per_count)},
          {"highest_counts", rounded(profile.highest, per_count)},
          {"fastest_counts_per_s", rounded(profile.fastest, per_count)},
          {"positions_counts", rounded(profile.positions, per_count)},
          {"velocities_counts_per_s", rounded(profile.velocities, per_count)},
          {"drives", profile.drives}};
}

json to_json(const Profile& profile) {
  json axes = json::array();
  for (const AxisProfile& axis : profile.axes) {
    axes.push_back(to_json(axis));
  }
  return {{"basis", basis_name(profile.basis)},
          {"why", profile.why.empty() ? json() : json(profile.why)},
          {"times_s", rounded(profile.times_s, per_s)},
          {"axes", std::move(axes)}};
}

/** Where all axes are at a sample: those of the profile there, the others where they were. */
AxisPositions at_sample(const Robot& robot, const AxisPositions& start, const Profile& profile,
                        std::size_t sample) {
  AxisPositions positions = start;
  for (std::size_t place = 0; place < robot.axes.size(); ++place) {
    for (const AxisProfile& axis : profile.axes) {
      if (axis.slot == robot.axes[place].slot) {
        positions[place] = axis.positions[sample] / robot.axes[place].counts_per_unit;
      }
    }
  }
  return positions;
}

Known<json> ghost_along(const Robot& robot, const PoseSetup& setup, const AxisPositions& start,
                        const Profile& profile) {
  const Eigen::Vector3d tip(0.0, 0.0, setup.kinematics.probe().treatment_to_tip_mm);
  json way = json::array();
  AxisPositions positions = start;
  Pose treatment;
  for (std::size_t sample = 0; sample < profile.axes.front().positions.size(); ++sample) {
    positions = at_sample(robot, start, profile, sample);
    const auto zframe_from_treatment = setup.kinematics.zframe_from_treatment(positions);
    if (!zframe_from_treatment) {
      return tl::unexpected(interlock::to_json(zframe_from_treatment.error()));
    }
    treatment = setup.registration.scanner_from_zframe() * *zframe_from_treatment;
    way.push_back(list_of(treatment * tip));
  }
  return body_view(setup, positions).map([&](json body) {
    return json{{"treatment", row_major(treatment)},
                {"tip", list_of(treatment * tip)},
                {"tip_path", std::move(way)},
                {"body", std::move(body)}};
  });
}

Known<json> ghost_of(const Robot& robot, const Targeting& targeting, const Proposal& proposal,
                     const Profile& profile) {
  if (profile.axes.empty()) {
    return tl::unexpected(json{{"code", "NO_PLAN"}, {"text", profile.why}});
  }
  return picture_setup(robot, targeting).and_then([&](const PictureSetup& setup) {
    return known_positions(robot, proposal.checked_against->state)
        .and_then([&](const AxisPositions& start) { return ghost_along(robot, setup.poses, start, profile); })
        .map([&](json ghost) {
          ghost["frame"] = setup.frame;
          return ghost;
        });
  });
}

}  // namespace

json proposal_plan(const Robot& robot, const ilk_config_t& config, const Targeting& targeting,
                   const Proposal& proposal) {
  const Profile profile = profile_of(robot, config, proposal);
  const Known<json> ghost = ghost_of(robot, targeting, proposal, profile);
  json checks = json::array();
  for (const CheckResult& result : proposal.checks) {
    checks.push_back(to_json(result));
  }
  const auto& start = proposal.checked_against;
  return {{"id", proposal.id},
          {"checked_tick", start == nullptr ? json() : json(start->state.system.tick)},
          {"checks", std::move(checks)},
          {"profile", to_json(profile)},
          {"ghost", ghost.value_or(json())},
          {"ghost_problem", ghost ? json() : ghost.error()}};
}

}  // namespace interlock
