#include "cli/store_place.hpp"

#include "cli/commands.hpp"
#include "cli/state_directory.hpp"
#include "robot/robot_file.hpp"
#include "store/noted_heads.hpp"
#include "store/store_files.hpp"

namespace interlock::cli {

namespace fs = std::filesystem;

Result<fs::path> state_of(const StorePlace& place, const Installation& installation) {
  if (!place.state.empty()) {
    return state_directory(place.state, "");
  }
  const Result<fs::path> file = installation.robot(place.robot);
  if (!file) {
    return tl::unexpected(file.error());
  }
  const auto robot = load_robot(*file);
  if (!robot) {
    return tl::unexpected(robot_failure(robot.error()));
  }
  return state_directory("", robot->name);
}

Result<fs::path> store_file(const StorePlace& place, const Installation& installation) {
  return state_of(place, installation).map([](const fs::path& state) { return state / store_file_name; });
}

fs::path heads_file(const fs::path& state) {
  std::error_code ignored;
  const fs::path of_service = fs::path(state.string() + "-recordings") / noted_heads_file_name;
  return fs::exists(of_service, ignored) ? of_service : recordings_folder(state) / noted_heads_file_name;
}

Result<Store> open_store(const StorePlace& place, const Installation& installation) {
  const Result<fs::path> file = store_file(place, installation);
  if (!file) {
    return tl::unexpected(file.error());
  }
  std::error_code ignored;
  if (!fs::exists(*file, ignored) && !has_run_before(file->parent_path())) {
    return failed(ExitCode::precondition,
                  "there is no store " + file->string() +
                      "; start the robot once with `interlock run`, or choose another --robot or --state");
  }
  return Store::open(*file).map_error(failure_of);
}

Failure failure_of(const StoreError& error) {
  using Kind = StoreError::Kind;
  const bool in_the_way =
      error.kind == Kind::unavailable || error.kind == Kind::newer || error.kind == Kind::no_memory;
  return {in_the_way ? ExitCode::precondition : ExitCode::refused, error.message()};
}

}  // namespace interlock::cli
