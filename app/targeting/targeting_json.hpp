/**
 * @file
 * Alignments and refusals of the kinematics as JSON, for the command line and the HTTP interface.
 */
#pragma once

#include <nlohmann/json.hpp>

#include "targeting/alignment.hpp"

namespace interlock {

/** `code` and `text`, and the `quantity`, its `value` (null: not finite), `lowest` and `highest`. */
nlohmann::json to_json(const KinematicsError& error);

/** `offset_mm` (RAS), `distance_mm`, `angle_deg`. */
nlohmann::json to_json(const Deviation& deviation);

/** Adds `error_budget` and `error_budget_problem`, of which one is null: schemas `ErrorBudget` and
 * `TargetingProblem` of spec/openapi.yaml. */
void add_error_budget(nlohmann::json& json, const KinematicsResult<ErrorBudget>& budget);

/**
 * `desired`, `reachable` (16 numbers, row by row), `reachable_tip`, `setpoints` by axis with `counts` and
 * `position`, the names of `clamped` axes, `deviation`, `cannula_length_mm` (null unless the NeuroRobot's),
 * `error_budget`.
 */
nlohmann::json to_json(const Robot& robot, const Alignment& alignment);

}  // namespace interlock
