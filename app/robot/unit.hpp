/**
 * @file
 * Units in which people read the axes, and points in one of them.
 */
#pragma once

#include <array>
#include <string_view>

namespace interlock {

/** x, y and z in mm. */
using PointMm = std::array<double, 3>;

/** Unit in which people read an axis. */
enum class Unit { mm, rad };

/** "mm" or "rad". */
std::string_view unit_name(Unit unit);

}  // namespace interlock
