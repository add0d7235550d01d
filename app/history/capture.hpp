/**
 * @file
 * One axis in every single tick, from the kernel's black box.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "control/velocity_estimator.hpp"
#include "history/history.hpp"
#include "motion/force_watch.hpp"

namespace interlock {

/** How forces are read from the frames of the sensor card. */
struct CapturedForces {
  ForceInputs inputs;
  ForceScales scales;
};

/** Which ticks of which axis, and how what is not recorded as such is found from them. */
struct CaptureSpan {
  std::uint32_t slot = 0;
  std::uint32_t seconds = 1;          /**< of kernel time */
  std::optional<std::uint32_t> until; /**< last tick; nothing: the newest */
  VelocityRules velocity;
  std::optional<CapturedForces> forces; /**< of a robot with a needle */
};

/** `Capture` of spec/openapi.yaml, or why the black box cannot be read. It takes milliseconds for each
 * second. */
tl::expected<nlohmann::json, std::string> capture(const std::filesystem::path& black_box,
                                                  const CaptureSpan& span);

}  // namespace interlock
