#include "proposals/check_list.hpp"

#include <array>

namespace interlock {
namespace {

struct CheckText {
  std::string_view name;
  std::string_view words;
};

/** In the order of `CheckName`. */
constexpr std::array<CheckText, 17> texts{{
    {"other_motion", "No homing and no motion of another mode is open."},
    {"targeting",
     "Registration, probe, target and where the axes stand are still those from which it followed."},
    {"configuration", "The kernel runs the configuration of this robot's file."},
    {"mode", "The kernel is READY or in MOTION."},
    {"axes", "Every axis is enabled and without a fault, and none that is to go to a position is homing."},
    {"homed", "Every axis is homed."},
    {"drive", "The drive is within the bound of the axis."},
    {"range",
     "Every target is where the kernel takes setpoints: within the soft limits less the coast, or the "
     "travel of a press for an axis that is not homed."},
    {"separation", "Linked sliders never part farther than their linkage allows."},
    {"rates", "A jerk-limited motion within the rates of the axes leads there."},
    {"switches", "Every axis that is to home has a limit switch."},
    {"home_order", "What goes to a position is homed by then."},
    {"band", "Every frequency is in the allowed band of the axis."},
    {"force", "The force sensor told something within the last 20 ms."},
    {"skin", "The tip is at the skin or in front of it."},
    {"depth", "The insertion reaches the depth of the target."},
    {"instrument", "What goes into the patient is out as far as it goes."},
}};
static_assert(texts.size() == static_cast<std::size_t>(CheckName::instrument) + 1);

}  // namespace

std::string_view check_name(CheckName name) noexcept { return texts[static_cast<std::size_t>(name)].name; }

std::string_view check_words(CheckName name) noexcept { return texts[static_cast<std::size_t>(name)].words; }

}  // namespace interlock
