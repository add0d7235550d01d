/**
 * @file
 * What a family gives for the parameters of its file: kinematics, and which of them can be calibrated.
 */
#pragma once

#include <initializer_list>
#include <string>

#include "kinematics/kinematics.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

/** The kinematics, shared; or null, and the table refused at the key of the first quantity that cannot work.
 */
template <typename Family>
KinematicsPtr accepted(TableReader& table, const KinematicsResult<Family>& kinematics) {
  if (!kinematics) {
    table.refuse(kinematics.error().quantity, kinematics.error().message(), "lengths that work together");
    return nullptr;
  }
  return std::make_shared<const Family>(*kinematics);
}

/** Lengths that measured poses can correct, each plausibly wrong by `plausible_mm`. */
inline std::vector<CalibratedNumber> calibrated_lengths(std::initializer_list<const char*> keys) {
  std::vector<CalibratedNumber> numbers;
  for (const char* const key : keys) {
    numbers.push_back({key, Unit::mm, plausible_mm});
  }
  return numbers;
}

}  // namespace interlock
