/**
 * @file
 * `interlock record`: writes out what the black box of a running, or killed, kernel holds.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <ostream>

#include "cli/exit_code.hpp"
#include "cli/store_place.hpp"

namespace interlock::cli {

struct RecordOptions {
  StorePlace place;
  std::filesystem::path black_box; /**< empty: that of `interlock run` with this robot and state */
  std::filesystem::path file; /**< empty: a new one among the robot's recordings, or here with `black_box` */
  std::uint32_t seconds = 60; /**< of kernel time */
};

/** PRECONDITION when there is no black box, or the file cannot be written or is there already. */
Result<void> record(const RecordOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
