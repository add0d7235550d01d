/**
 * @file
 * Gains for an axis, found on the simulated robot.
 */
#pragma once

#include "robot/robot.hpp"
#include "tuning/step_run.hpp"

namespace interlock {

/** Gains, of three digits, and how well the worst step went with them. */
struct FoundGains {
  Gains gains;
  double rms_velocity_error_percent = 0.0; /**< of the worst of the steps */
  double begun_with_percent = 0.0;         /**< the same, with the gains of the beginning */
};

/**
 * From the gains of the robot's file, or those asked for, in steps of a half up or down, one gain after the
 * other, to where no step makes the worst of three steps better: the one that the options say, the same with
 * every MOVE ten ticks later, and the same at a third of its speed. Whatever is found is at least as good as
 * the beginning.
 *
 * The error is that of `run_step` with the gains of the beginning.
 */
RigResult<FoundGains> search_gains(const Robot& robot, const ilk_config_t& config,
                                   const plant::Parameters& parameters, const StepOptions& options);

}  // namespace interlock
