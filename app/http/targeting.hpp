/**
 * @file
 * Registration, entry, target and probe offsets: schema `Targeting` of spec/openapi.yaml.
 *
 * Poses and points are in the scanner's frame (RAS), mm; a pose is a 4x4 matrix, row-major.
 */
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

/** A matrix of 4 by 4, row by row, in mm. */
using Pose = std::array<double, 16>;
/** x, y and z in mm. */
using Point = std::array<double, 3>;

/** Farthest coordinate of a point, or of the origin of a pose. */
constexpr double farthest_mm = 10000.0;
/** Largest offset of the probe. */
constexpr double largest_offset_mm = 1000.0;
/** How far the elements of R^T R may be from those of the identity, and its determinant from 1. */
constexpr double rigid_tolerance = 1e-3;

/** What an aim is made from. */
struct Targeting {
  Pose registration{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; /**< the robot in the scanner */
  bool ignore_registration_rotation = false;
  std::optional<Point> entry_point;
  std::optional<Point> target_point;
  double treatment_to_tip_mm = 0.0;           /**< A */
  double robot_to_entry_mm = 0.0;             /**< B */
  double cannula_to_treatment_mm = 0.0;       /**< C */
  double treatment_to_robot_at_home_mm = 0.0; /**< D */
  std::optional<Pose> reported_position;      /**< as an imager reported it */

  bool operator==(const Targeting&) const = default;
};

/** Schema `Targeting`; also how it is stored. */
nlohmann::json to_json(const Targeting& targeting);

/** What `to_json` wrote; the problem of a value that was not written by it. */
tl::expected<Targeting, Problem> stored_targeting(const nlohmann::json& stored);

/**
 * What a body changes: each gives the changed values, or 422 INVALID naming the field or the element, and the
 * rule.
 */
tl::expected<Targeting, Problem> with_registration(Targeting targeting, const nlohmann::json& body);
/** The targeting with the robot's pose as the imager reports it. */
tl::expected<Targeting, Problem> with_reported_pose(Targeting targeting, const nlohmann::json& body);
/** The targeting with another target. */
tl::expected<Targeting, Problem> with_target(Targeting targeting, const nlohmann::json& body);

/** Sets entry and target by the pose that the treatment point is to have: it comes along the pose's third
 * axis, from as far off as entry and target were before, or 50 mm. */
void aim_at(Targeting& targeting, const Pose& pose);

/** A rigid pose in the field `name` of a body; 422 INVALID naming the element, and the rule. */
tl::expected<Pose, Problem> rigid_pose(const nlohmann::json& body, const std::string& name);

}  // namespace interlock::web
