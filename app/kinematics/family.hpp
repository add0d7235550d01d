/**
 * @file
 * The families of kinematics, as a robot file names them.
 *
 * A family is a folder below this one: its `family.cpp` defines `read_FOLDER`, which reads the family's
 * parameters and gives its kinematics (kinematics/kinematics.hpp). The build collects the folders; nothing
 * else lists them.
 */
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <utility>

namespace interlock {

class Kinematics;
class TableReader;

/** Never changes; shared by whoever holds the robot. */
using KinematicsPtr = std::shared_ptr<const Kinematics>;

/** Reads the [kinematics] table, all keys but `family`. Null when it is refused; the table holds the reason.
 */
using ReadKinematics = KinematicsPtr (*)(TableReader& table);

/** The folder's name, which is the family's, and its reader. */
using KinematicsFamily = std::pair<std::string_view, ReadKinematics>;

/** Every folder below app/kinematics, in alphabetical order. */
std::span<const KinematicsFamily> kinematics_families();

/** Offsets along the probe by which a target is reached, in mm; A to D of the thesis. */
struct ProbeOffsets {
  double treatment_to_tip_mm = 0.0;           /**< A */
  double robot_to_entry_mm = 0.0;             /**< B */
  double cannula_to_treatment_mm = 0.0;       /**< C */
  double treatment_to_robot_at_home_mm = 0.0; /**< D */

  bool operator==(const ProbeOffsets&) const = default;
};

}  // namespace interlock
