#include "plant/parameters.hpp"

#include <algorithm>

namespace interlock::plant {

double position_from_switch(const ilk_axis_config_t& axis, double counts) {
  return axis.home_offset_counts + (axis.limit_side == ILK_LIMIT_UPPER ? -counts : counts);
}

Parameters default_parameters(const ilk_config_t& robot) {
  Parameters parameters;
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const ilk_axis_config_t& axis = robot.axis[slot];
    parameters.sensor[slot].name = "sensor " + std::to_string(slot);
    if (!drives_motor(axis.card)) {
      continue;
    }
    const double lower = axis.min_counts;
    const double upper = axis.max_counts;
    parameters.axis[slot].name = "axis " + std::to_string(slot);
    parameters.axis[slot].start_counts =
        axis.limit_side == ILK_LIMIT_NONE ? std::clamp(0.0, lower, upper)
                                          : position_from_switch(axis, std::min(300.0, (upper - lower) / 3));
  }
  return parameters;
}

}  // namespace interlock::plant
