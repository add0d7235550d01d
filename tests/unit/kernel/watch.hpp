/// Judges each tick from the outside: what went to the wire against what came in. Holds for every run,
/// however hostile, so every test runs under it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "codec.hpp"
#include "interlock/types.h"

namespace interlock::kernel_test {

class SafetyWatch {
 public:
  SafetyWatch(const ilk_config_t& config, ilk_mode_t mode) : config_(config), mode_(mode) {}

  /// Adds a test failure for the first rule that this tick breaks; later ticks of a failed run are not
  /// judged.
  void judge(const ilk_inputs_t& in, std::span<const ilk_request_t> requests, uint32_t count,
             const ilk_state_t& state, const ilk_outputs_t& out);

  const ilk_config_t& config() const { return config_; }

 private:
  struct AxisView {
    uint32_t bad_frames = 0;
    bool valid = false;
    std::optional<uint32_t> raw;
    uint64_t periods = 0;
    uint64_t jump = 0;
    uint32_t lease = 0;
    bool homing = false;
    uint32_t state = ILK_AXIS_DISABLED;
  };

  void observe_frames(const ilk_inputs_t& in);
  void observe_contacts(const ilk_inputs_t& in);
  void observe_verdicts(std::span<const ilk_request_t> requests, const ilk_outputs_t& out);
  std::string judge_verdicts(std::span<const ilk_request_t> requests, uint32_t count,
                             const ilk_outputs_t& out) const;
  std::string judge_modes(const ilk_state_t& state, const ilk_outputs_t& out) const;
  std::string judge_axis(uint32_t slot, const ilk_inputs_t& in, const ilk_state_t& state,
                         const ilk_outputs_t& out) const;
  std::string judge_drive(uint32_t slot, const ilk_inputs_t& in, const ilk_state_t& state,
                          const ilk_outputs_t& out) const;
  void remember(const ilk_state_t& state, const ilk_outputs_t& out);

  ilk_config_t config_;
  std::array<AxisView, ILK_SLOTS> axis_{};
  bool failed_ = false;
  std::optional<uint32_t> echo_;       ///< tick counter of the transaction before
  std::optional<uint32_t> last_sent_;  ///< tick counter of the last outgoing frames
  bool pressed_ = false;
  bool released_ = false;
  uint32_t released_in_ready_ = 0;
  uint32_t pressed_ticks_ = 0;
  bool armed_ = false;
  uint32_t silent_ticks_ = UINT32_MAX;
  uint32_t holder_ = 0;
  std::set<uint32_t> consents_;  ///< of the orders accepted since MOTION began
  uint32_t mode_;
  uint32_t cause_ = ILK_CAUSE_BOOT;
  bool reset_accepted_ = false;
  uint32_t cleared_ = 0;    ///< slots whose CLEAR_FAULT was accepted in this tick
  uint32_t commanded_ = 0;  ///< slots whose MOVE or HOME was accepted in this tick
};

}  // namespace interlock::kernel_test
