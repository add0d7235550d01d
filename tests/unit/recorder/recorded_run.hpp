/// A kernel that runs and records what it does, in one process: in a random world, or in a calm one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "black_box.h"
#include "interlock/kernel.h"
#include "interlock/replay.h"
#include "recorder/ring.hpp"

extern "C" {
#include "world.h"
}

namespace interlock::recorder_test {

/// A folder that goes away with all that is in it.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What a tick was, as the kernel's host knew it.
struct KnownTick {
  ilk_picture_t picture;
  std::vector<ilk_request_t> requests;
  std::uint64_t begun_ns;
};

/// Fails the test with the reason.
void create_box(ilk_black_box_t& box, const ilk_config_t& config, std::uint32_t seconds);

/// As a reader sees the black box of a kernel in the same process.
recorder::Ring ring_of(const ilk_black_box_t& box);

/// Of the random world's robot at 1 kHz, in the world of that seed.
class RecordedRun {
 public:
  explicit RecordedRun(std::uint32_t seed = 1, std::uint32_t seconds = 2);
  ~RecordedRun();
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;

  /// Ticks in the random world, with everything that can go wrong; each is handed to `watch`.
  void run(std::uint32_t ticks, const std::function<void(const KnownTick&)>& watch = {});

  /// Ticks in which nothing happens: cards answer, the app speaks, nobody touches anything.
  void calm(std::uint32_t ticks);

  /// A calm tick with this request.
  void ask(ilk_request_kind_t kind, std::uint32_t axis = 0);

  /// A calm tick with the E-stop pressed.
  void press_estop();

  /// A calm tick in which this axis jumps: a fault.
  void make_jump(std::uint32_t axis);

  /// What a reader gets of the black box.
  [[nodiscard]] recorder::Ring ring() const { return ring_of(box_); }

  /// The kernel's end: in order, or as a kill leaves it, nothing said.
  void close();
  void die();

  [[nodiscard]] const ilk_state_t& state() const { return state_; }

 private:
  void calm_inputs();
  void put_request(ilk_request_kind_t kind, std::uint32_t axis);
  void step(const std::function<void(const KnownTick&)>& watch = {});

  ilk_config_t config_{};
  ilk_state_t state_{};
  ilk_inputs_t in_{};
  ilk_outputs_t out_{};
  std::vector<ilk_request_t> requests_;
  world_t world_{};
  ilk_black_box_t box_{};
  std::uint32_t counter_[ILK_SLOTS]{};
  bool open_ = true;
};

/// What a replay of the whole recording comes to; throws for a file that is none.
ilk_replay_report_t replayed(const std::filesystem::path& path);

}  // namespace interlock::recorder_test
