/**
 * @file
 * What a family's reader gives for the parameters that it read.
 */
#pragma once

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

}  // namespace interlock
