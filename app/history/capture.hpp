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

namespace interlock {

/** Which ticks of which axis. */
struct CaptureSpan {
  std::uint32_t slot = 0;
  std::uint32_t seconds = 1;          /**< of kernel time */
  std::optional<std::uint32_t> until; /**< last tick; nothing: the newest */
};

/** `Capture` of spec/openapi.yaml, or why the black box cannot be read. It takes milliseconds for each
 * second. */
tl::expected<nlohmann::json, std::string> capture(const std::filesystem::path& black_box,
                                                  const CaptureSpan& span);

}  // namespace interlock
