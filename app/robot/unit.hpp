/**
 * @file
 * Units in which people read the axes.
 */
#pragma once

#include <string_view>

namespace interlock {

/** Unit in which people read an axis. */
enum class Unit { mm, rad };

/** "mm" or "rad". */
std::string_view unit_name(Unit unit);

}  // namespace interlock
