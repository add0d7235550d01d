#include "motion/biopsy_run.hpp"

#include <algorithm>
#include <utility>

namespace interlock {

KinematicsResult<BiopsyRun> make_biopsy_run(const Biopsy& biopsy, double period_s, const BiopsyStart& start,
                                            const ForceCalibration& hand, const ForceCalibration& needle) {
  CompensatorParameters steering;
  steering.tip.curvature_per_mm = biopsy.curvature_per_mm;
  MembraneParameters membranes;
  membranes.period_s = period_s;
  CooperativeParameters hand_law;
  hand_law.deadband_n = biopsy.deadband_n;
  hand_law.gain_mm_s_n = biopsy.gain_mm_s_n;
  hand_law.fastest_mm_s = biopsy.fastest_mm_s;
  const NeedleAxes axes{0.0, std::max(0.0, start.insertion_mm - biopsy.entry_mm), start.rotation_rad};
  return check_cooperative(hand_law).and_then([&] {
    return MembraneDetector::create(membranes, start.membranes_mm).and_then([&](MembraneDetector detector) {
      return Compensator::create(steering, axes, start.target_mm).map([&](Compensator compensator) {
        return BiopsyRun{start.tick, biopsy.entry_mm,        hand_law,           hand,
                         needle,     std::move(compensator), std::move(detector)};
      });
    });
  });
}

}  // namespace interlock
