/**
 * @file
 * A run as a picture: position, velocity and control output over time, one above the other.
 */
#pragma once

#include <string>

#include "tuning/step_run.hpp"

namespace interlock {

/** A whole SVG document that needs nothing else. `title` may hold any text. */
std::string step_svg(const StepRun& run, const std::string& title);

}  // namespace interlock
