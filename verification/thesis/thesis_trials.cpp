#include "thesis_trials.hpp"

#include <array>
#include <cmath>

#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"

namespace interlock {
namespace {

constexpr std::string_view neuro_family = "neuro_rcm";
constexpr std::string_view prostate_family = "prostate_trapezoids";

/** Table 1, as printed: right, anterior, superior. Trial 4's and trial 6's printed errors do not agree with
 * these. */
const std::array<ThesisTrial, 7> neuro_trials{{
    {{-3.523, 61.989, 11.74}, {-5.618, 61.989, 12.378}},
    {{7.336, 61.989, 11.74}, {4.7, 61.989, 12.221}},
    {{-13.954, 61.989, -10.05}, {-16.43, 61.989, -8.107}},
    {{-14.726, 61.989, 33.837}, {-14.32, 61.989, 35.728}},
    {{-26.786, 62.989, 19.032}, {-28.664, 62.989, 20.691}},
    {{-7.085, 61.989, -10.516}, {-4.617, 61.989, -12.061}},
    {{-17.752, 61.989, 9.283}, {-15.844, 61.989, 8.786}},
}};

/** Table 2, as printed. Its X behaves like the height of the needle and its Y like its lateral place. */
const std::array<ThesisTrial, 7> prostate_trials{{
    {{141.0, 0.0, 132.5}, {141.113, 0.012, 133.221}},
    {{150.0, 5.0, 132.5}, {150.671, 5.022, 131.191}},
    {{130.0, -5.0, 152.5}, {130.523, -5.108, 151.203}},
    {{120.0, 0.0, 112.5}, {120.455, 1.092, 112.616}},
    {{145.0, 15.0, 122.5}, {145.431, 14.567, 122.337}},
    {{147.0, -2.0, 152.5}, {147.466, -2.119, 152.196}},
    {{133.0, -2.0, 252.0}, {132.702, -2.119, 252.011}},
}};

const ThesisTable neuro_table{
    "Table 1, NeuroRobot",
    "right, anterior and superior of the table are x, y and z of the robot; the middle of its targets is at "
    "(-6, 205, 45) mm; the way in is 45 mm long, at yaw -0.2 rad",
    neuro_trials};

const ThesisTable prostate_table{"Table 2, prostate robot",
                                 "X of the table is the height of the needle plus 15 mm, as the window of "
                                 "the sliders begins at 132.7 mm; Y is its lateral place; Z is "
                                 "its depth plus 110 mm, for another needle; the way in is along the needle",
                                 prostate_trials};

/** Where the middle of Table 1's targets is put, in the zFrame. */
const Eigen::Vector3d neuro_centre{-6.0, 205.0, 45.0};
/** Yaw -0.2 rad, for the robot does not reach yaw 0: the upper soft limit less the coast is below it. */
const Eigen::Vector3d neuro_advance{0.0, -std::cos(0.2), -std::sin(0.2)};
constexpr double neuro_depth_mm = 45.0;
constexpr double prostate_height_mm = 15.0;
constexpr double prostate_depth_mm = 110.0;
constexpr double prostate_way_mm = 50.0;

Eigen::Vector3d middle_of(std::span<const ThesisTrial> trials) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ThesisTrial& trial : trials) {
    sum += trial.desired;
  }
  return sum / static_cast<double>(trials.size());
}

Way neuro_way(const ThesisTrial& trial) {
  const Eigen::Vector3d target = neuro_centre + trial.desired - middle_of(neuro_trials);
  return {target - neuro_depth_mm * neuro_advance, target};
}

Way prostate_way(const ProstateTrapezoids& geometry, const ThesisTrial& trial) {
  const Eigen::Vector3d in_base(trial.desired.y(), trial.desired.x() + prostate_height_mm,
                                trial.desired.z() + prostate_depth_mm);
  const Eigen::Vector3d target = in_base - Eigen::Vector3d(geometry.base_to_zframe_mm.data());
  return {target - Eigen::Vector3d(0.0, 0.0, prostate_way_mm), target};
}

}  // namespace

bool has_thesis_table(const Robot& robot) {
  return robot.family == neuro_family || robot.family == prostate_family;
}

const ThesisTable& thesis_table(const Robot& robot) {
  return robot.family == neuro_family ? neuro_table : prostate_table;
}

Eigen::Matrix3d zframe_from_table(const Robot& robot) {
  return robot.family == neuro_family ? Eigen::Matrix3d::Identity()
                                      : (Eigen::Matrix3d() << 0, 1, 0, 1, 0, 0, 0, 0, 1).finished();
}

Way way_of(const Robot& robot, const ThesisTrial& trial) {
  const auto* prostate = dynamic_cast<const ProstateKinematics*>(robot.kinematics.get());
  return prostate == nullptr ? neuro_way(trial) : prostate_way(prostate->geometry(), trial);
}

}  // namespace interlock
