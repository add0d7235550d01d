#include "igtl/workphases.hpp"

namespace interlock::igtl {

std::string Brp2013::forbids(Phase /*wanted*/, const RobotState& /*state*/) const { return {}; }

}  // namespace interlock::igtl
