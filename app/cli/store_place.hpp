/**
 * @file
 * Which store a command works on.
 */
#pragma once

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "store/store.hpp"

namespace interlock::cli {

struct StorePlace {
  std::string robot = "neuro"; /**< name or file */
  std::filesystem::path state; /**< empty: the robot's directory under $XDG_STATE_HOME/interlock */
};

/** The state directory that `interlock run` uses with the same options. */
Result<std::filesystem::path> state_of(const StorePlace& place, const Installation& installation);

/** The file of the store in it. */
Result<std::filesystem::path> store_file(const StorePlace& place, const Installation& installation);

/** The recorder's file of the heads that it noted: of a service, or of `interlock run`. */
std::filesystem::path heads_file(const std::filesystem::path& state);

/** Opens a store that is there. Refused where there is none, so that looking at one does not make it. */
Result<Store> open_store(const StorePlace& place, const Installation& installation);

/** A refusal of the store as the command's. */
Failure failure_of(const StoreError& error);

}  // namespace interlock::cli
