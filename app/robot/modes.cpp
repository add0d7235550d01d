#include "robot/modes.hpp"

#include <algorithm>

namespace interlock {

std::optional<KnownMode> mode_of(std::string_view name) {
  const auto modes = known_modes();
  const auto found =
      std::ranges::find_if(modes, [name](const KnownMode& each) { return each.mode.name == name; });
  return found == modes.end() ? std::nullopt : std::optional(*found);
}

std::string mode_names() {
  std::string names;
  for (const KnownMode& each : known_modes()) {
    names += (names.empty() ? "" : ", ") + std::string(each.mode.name);
  }
  return names;
}

}  // namespace interlock
