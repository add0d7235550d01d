#include "cli/record_command.hpp"

#include <string>
#include <system_error>

#include "build_info/build_info.hpp"
#include "cli/black_box_place.hpp"
#include "recorder/recorder.hpp"

namespace interlock::cli {

namespace fs = std::filesystem;

Result<void> record(const RecordOptions& options, const Installation& installation, std::ostream& output) {
  const Result<fs::path> state = state_of(options.place, installation);
  if (!state) {
    return tl::unexpected(state.error());
  }
  const recorder::Recorded<recorder::Ring> ring = recorder::Ring::open(black_box_file(*state));
  if (!ring) {
    return failed(
        ExitCode::precondition,
        ring.error() + "; start the robot with `interlock run`, or choose another --robot or --state");
  }
  const std::uint32_t tick = ring->opening_tick(ring->head()).value_or(0);
  const fs::path file =
      options.file.empty()
          ? recordings_folder(*state) / recorder::recording_name(ring->run(), ILK_RECORDED_ON_DEMAND, tick)
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
