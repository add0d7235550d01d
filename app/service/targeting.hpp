/**
 * @file
 * Registration, entry, target and probe offsets: schema `Targeting` of spec/openapi.yaml, and what they were
 * before.
 *
 * Poses and points are in the scanner's frame (RAS), mm; a pose is a 4x4 matrix, row-major.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "robot/robot.hpp"
#include "service/reply.hpp"

namespace interlock {

/** x, y and z in mm. */
using Point = std::array<double, 3>;

/** Farthest coordinate of a point, or of the origin of a pose. */
constexpr double farthest_mm = 10000.0;
/** Largest offset of the probe. */
constexpr double largest_offset_mm = 1000.0;
/** How far the elements of R^T R may be from those of the identity, and its determinant from 1. */
constexpr double entered_rigidity = 1e-3;

/** Largest residual of a registration. */
constexpr double largest_residual_mm = 1000.0;
/** A rigid registration needs three points. */
constexpr std::int64_t fewest_fiducials = 3;
/** More points than this are no fiducials. */
constexpr std::int64_t most_fiducials = 1000;

/** Largest entry of a covariance. */
constexpr double largest_variance_mm2 = 10000.0;

/** Characters of a reason. */
constexpr std::size_t longest_reason = 200;

/** Planned targets of a case. */
constexpr std::size_t most_planned_targets = 100;
/** Characters of the name of one. */
constexpr std::size_t longest_target_name = 40;

/** Largest number of an epoch: JSON carries it exactly. */
constexpr std::int64_t latest_epoch = (std::int64_t{1} << 53) - 1;

/** What is in force of all that is stored. */
struct InForce {
  /** The present epoch of registrations: one of an earlier epoch has expired. Each start of the app begins an
   * epoch, and whatever moves the robot in the scanner begins another. */
  std::int64_t epoch = 0;
  std::string reason = "The app was started since."; /**< why those before it expired */
  /** Number of the case that somebody has opened or resumed since the app was started; 0: of none. */
  std::int64_t open_case = 0;
};

/** A place that somebody plans to go to. Nothing goes there before it is set as entry and target. */
struct PlannedTarget {
  std::string name;
  Point entry_point{};
  Point target_point{};

  bool operator==(const PlannedTarget&) const = default;
};

/** What an aim is made from. All of it belongs to a case. */
struct Targeting {
  std::int64_t case_number = 0; /**< of the case; 0: none is in hand. Kept with the case */
  /** Why nothing of it is in force; empty: it is. Not kept: the store tells a part of it, and `judged` the
   * rest. */
  std::string case_problem = {};
  std::optional<RowMajor> registration; /**< the robot in the scanner; empty: nobody has ever set it */
  bool ignore_registration_rotation = false;
  std::optional<double> residual_mm;     /**< root mean square over the fiducials, if its sender has it */
  std::optional<std::int64_t> fiducials; /**< by how many it was found, if its sender says so */
  std::vector<Point> fiducial_points;    /**< where they were in the scanner, if its sender says so */
  std::int64_t registration_epoch = 0;   /**< in which it was set */
  std::string registration_expired;      /**< why, where that is kept; empty: it has not */
  std::string registration_doubt;        /**< why it can hardly be right; empty: it can */
  std::string override_reason;           /**< why somebody set it all the same */
  /** Why no pose may be made with it; empty: it is valid. Not kept: `judged` finds it anew. */
  std::string registration_problem = "The registration is not set.";
  std::int64_t present_epoch = 0; /**< in which it was judged; not kept */
  std::optional<Point> entry_point;
  std::optional<Point> target_point;
  std::optional<std::array<double, 9>> target_covariance_mm2; /**< of that point, if its sender says so */
  std::vector<PlannedTarget> planned_targets;                 /**< in the order of whoever planned them */
  double treatment_to_tip_mm = 0.0;                           /**< A */
  double robot_to_entry_mm = 0.0;                             /**< B */
  double cannula_to_treatment_mm = 0.0;                       /**< C */
  double treatment_to_robot_at_home_mm = 0.0;                 /**< D */
  std::optional<RowMajor> reported_position;                  /**< as an imager reported it */

  bool operator==(const Targeting&) const = default;
};

/** How far apart both put the robot; up to 1 they are the same to a program, which may round what it repeats,
 * and whose tracker has noise: 2 mm and a degree in each coordinate. */
double registration_distance(const RowMajor& one, const RowMajor& other, bool ignores_rotation);

/** The same with what is true of its case and its registration by what is in force. */
Targeting judged(Targeting targeting, const InForce& in_force);

/** Schema `Targeting`, of what was judged. */
nlohmann::json to_json(const Targeting& targeting);

/** How it is stored. */
nlohmann::json to_stored(const Targeting& targeting);

/** What `to_stored` wrote, not yet judged; the problem of a value that was not written by it. */
tl::expected<Targeting, Problem> stored_targeting(const nlohmann::json& stored);

/**
 * What a body changes: each gives the changed values, or 422 INVALID naming the field or the element, and the
 * rule. A registration is one of the epoch in which the values before were judged.
 */
tl::expected<Targeting, Problem> with_registration(Targeting targeting, const nlohmann::json& body);
/** As set, when there is no doubt of the registration or somebody overrode the doubt; else 422 IMPLAUSIBLE
 * with the suspicion in words. */
tl::expected<Targeting, Problem> plausible(Targeting targeting, const Robot& robot);
/** The targeting with the robot's pose as the imager reports it. */
tl::expected<Targeting, Problem> with_reported_pose(Targeting targeting, const nlohmann::json& body);
/** The targeting with another target. */
tl::expected<Targeting, Problem> with_target(Targeting targeting, const nlohmann::json& body);
/** The targeting with other planned targets. */
tl::expected<Targeting, Problem> with_planned_targets(Targeting targeting, const nlohmann::json& body);
/** The targeting without entry and target. */
tl::expected<Targeting, Problem> without_target(Targeting targeting, const nlohmann::json& body);

/** Entry, target and those of the planned targets. */
std::vector<Point> points_of(const Targeting& targeting);

/** Sets entry and target by the pose that the treatment point is to have: it comes along the pose's third
 * axis, from as far off as entry and target were before, or 50 mm. */
void aim_at(Targeting& targeting, const RowMajor& pose);

/** A rigid pose in the field `name` of a body; 422 INVALID naming the element, and the rule. */
tl::expected<RowMajor, Problem> rigid_pose(const nlohmann::json& body, const std::string& name);

}  // namespace interlock
