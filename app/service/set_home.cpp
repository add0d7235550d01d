#include "service/set_home.hpp"

namespace interlock {

bool has_switch(const Axis& axis) { return axis.limit != ILK_LIMIT_NONE; }

Refusal switch_knows_home(const Axis& axis) {
  return {"HAS_SWITCH", axis.name + " has a limit switch, which tells where its home is.",
          "an axis without a switch, or override_switch",
          "Home it. Override the switch only if it is broken and you know where the axis stands."};
}

}  // namespace interlock
