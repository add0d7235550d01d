#include <optional>
#include <string>
#include <system_error>

#include "build_info/build_info.hpp"
#include "cli/commands.hpp"
#include "cli/instance_lock.hpp"
#include "recorder/recorder.hpp"

namespace interlock::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* next_step =
    "; start the robot with `interlock run`, choose another --robot or --state, or be the user of the kernel "
    "whose --black-box it is";

struct Place {
  fs::path black_box;
  fs::path recordings; /**< folder */
};

/** Of `interlock run`, unless another black box was named. */
Result<Place> place_of(const RecordOptions& options, const Installation& installation) {
  if (!options.black_box.empty()) {
    return Place{options.black_box, fs::path()};
  }
  return state_of(options.place, installation).and_then([](const fs::path& state) -> Result<Place> {
    const std::optional<fs::path> black_box = running_black_box(state);
    if (!black_box) {
      return failed(ExitCode::precondition,
                    "no robot runs with the state directory " + state.string() + next_step);
    }
    return Place{*black_box, recordings_folder(state)};
  });
}

}  // namespace

fs::path recordings_folder(const fs::path& state) { return state / "recordings"; }

Result<void> record(const RecordOptions& options, const Installation& installation, std::ostream& output) {
  const Result<Place> place = place_of(options, installation);
  if (!place) {
    return tl::unexpected(place.error());
  }
  const recorder::Recorded<recorder::Ring> ring = recorder::Ring::connect(place->black_box);
  if (!ring) {
    return failed(ExitCode::precondition, ring.error() + next_step);
  }
  const std::uint32_t tick = ring->opening_tick(ring->head()).value_or(0);
  const fs::path file =
      options.file.empty()
          ? place->recordings / recorder::recording_name(ring->run(), ILK_RECORDED_ON_DEMAND, tick)
          : options.file;
  std::error_code error;
  fs::create_directories(fs::absolute(file).parent_path(), error);
  if (fs::exists(file, error)) {
    return failed(ExitCode::precondition, file.string() + " is there already; choose another file with -o");
  }
  const recorder::RecordingSubject subject{ILK_RECORDED_ON_DEMAND, tick,
                                           std::string(version()) + ' ' + std::string(commit())};
  const recorder::Recorded<std::uint32_t> blocks =
      recorder::record_now(*ring, fs::absolute(file), subject, options.seconds);
  if (!blocks) {
    return failed(ExitCode::precondition, blocks.error());
  }
  output << file.string() << '\n';
  return {};
}

}  // namespace interlock::cli
