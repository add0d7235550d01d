#include "robot/kinematics.hpp"

namespace interlock {
namespace {

constexpr std::array<KinematicRole, 7> neuro_roles{{
    {"yaw", Unit::rad},
    {"probe_rotation", Unit::rad},
    {"pitch", Unit::rad},
    {"insertion", Unit::mm},
    {"lateral", Unit::mm},
    {"head", Unit::mm},
    {"feet", Unit::mm},
}};

constexpr std::array<KinematicRole, 6> prostate_roles{{
    {"rotation", Unit::rad},
    {"insertion", Unit::mm},
    {"back_left", Unit::mm},
    {"front_left", Unit::mm},
    {"back_right", Unit::mm},
    {"front_right", Unit::mm},
}};

}  // namespace

std::string_view family_name(const Kinematics& kinematics) {
  return std::holds_alternative<NeuroRcm>(kinematics) ? "neuro_rcm" : "prostate_trapezoids";
}

std::span<const KinematicRole> roles_of(const Kinematics& kinematics) {
  return std::holds_alternative<NeuroRcm>(kinematics) ? std::span<const KinematicRole>(neuro_roles)
                                                      : std::span<const KinematicRole>(prostate_roles);
}

}  // namespace interlock
