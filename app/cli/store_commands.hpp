/**
 * @file
 * `interlock store backup|restore`.
 */
#pragma once

#include <filesystem>
#include <ostream>

#include "cli/exit_code.hpp"
#include "cli/store_place.hpp"

namespace interlock::cli {

struct StoreOptions {
  StorePlace place;
  std::filesystem::path file;
};

/** Copies the store to a new file, also while the app runs, and checks the copy. */
Result<void> backup(const StoreOptions& options, const Installation& installation, std::ostream& output);

/** Puts a backup in the place of the store, which is kept beside it. Refused while an instance runs. */
Result<void> restore(const StoreOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
