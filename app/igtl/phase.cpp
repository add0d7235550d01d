#include "igtl/phase.hpp"

#include <array>

namespace interlock::igtl {
namespace {

/** In the order of `Phase`. */
constexpr std::array<std::string_view, 9> phase_names{"UNDEFINED",   "START_UP",  "PLANNING",
                                                      "CALIBRATION", "TARGETING", "MOVE_TO_TARGET",
                                                      "MANUAL",      "STOP",      "EMERGENCY"};

}  // namespace

std::string_view phase_name(Phase phase) noexcept { return phase_names[static_cast<std::size_t>(phase)]; }

std::optional<Phase> requested_phase(std::string_view name) noexcept {
  for (std::size_t i = 1; i < phase_names.size(); ++i) {
    if (phase_names[i] == name) {
      return static_cast<Phase>(i);
    }
  }
  return std::nullopt;
}

}  // namespace interlock::igtl
