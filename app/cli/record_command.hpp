/**
 * @file
 * `interlock record`: writes out what the black box of a running kernel holds.
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
  std::filesystem::path black_box; /**< socket; empty: that of `interlock run` with this robot and state */
  std::filesystem::path file; /**< empty: a new one among the robot's recordings, or here with `black_box` */
  std::uint32_t seconds = 60; /**< of kernel time */
};

/** The folder of a robot's recordings. */
std::filesystem::path recordings_folder(const std::filesystem::path& state);

/** PRECONDITION when there is no black box, or the file cannot be written or is there already. */
Result<void> record(const RecordOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
