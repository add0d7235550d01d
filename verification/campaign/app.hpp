/**
 * @file
 * The people and programs before the kernel: a foot on the pedal and an app that unlocks, enables, homes and
 * moves; on demand it falls silent, lies or floods.
 */
#ifndef INTERLOCK_CAMPAIGN_APP_HPP
#define INTERLOCK_CAMPAIGN_APP_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "interlock/types.h"
#include "plant/random.hpp"

namespace interlock::campaign {

/** How the people before the kernel behave in a case. */
enum class Manner : std::uint8_t {
  kUsual,
  kSteady, /**< the foot stays down until it is lifted, nobody asks for STOP or DISABLE, and an axis that has
                run into its end is left alone */
  kHoming, /**< the foot stays down as well, and nothing moves but axes that are homed, again and again */
};

class App {
 public:
  /** More than the kernel looks at in one tick. */
  static constexpr std::size_t kMostRequests = 24;

  App(const ilk_config_t& config, std::uint64_t seed, Manner manner);

  /** Acts on what the kernel last showed, once a tick. */
  void act(std::uint32_t tick, const ilk_state_t& shown);

  std::span<const ilk_request_t> requests() const { return std::span(requests_).first(count_); }

  bool foot_is_down() const { return foot_down_; }
  std::uint32_t generation() const { return generation_; }
  std::uint32_t heartbeat_tick() const { return heartbeat_tick_; }

  void lift_foot(std::uint32_t ticks) { lifted_ticks_ = std::max(lifted_ticks_, ticks); }
  void fall_silent(std::uint32_t ticks) { silent_ticks_ = std::max(silent_ticks_, ticks); }
  void lie(std::uint32_t ticks) { lying_ticks_ = std::max(lying_ticks_, ticks); }
  void flood(std::uint32_t ticks) { flooding_ticks_ = std::max(flooding_ticks_, ticks); }
  void attach_anew();
  void hand_over() { holder_++; }

 private:
  /** What the app wants of an axis during one press. */
  struct Intent {
    bool takes_part = false;
    bool homes = false;
    std::int32_t target = 0;
    std::uint32_t drive = 0;
    std::uint32_t renew_tick = 0;
  };

  std::uint32_t choose_hold();
  bool may_press(const ilk_state_t& shown) const;
  void move_foot(const ilk_state_t& shown);
  void prepare_axis(std::uint32_t tick, const ilk_state_t& shown, std::uint32_t slot);
  void drive_axis(std::uint32_t tick, const ilk_state_t& shown, std::uint32_t slot);
  void choose_target(const ilk_state_t& shown, std::uint32_t slot);
  void tell_a_lie(const ilk_state_t& shown);
  void send(ilk_request_t request, bool intact = true);
  ilk_request_t draft(ilk_request_kind_t kind, std::uint32_t slot);
  void ask(ilk_request_kind_t kind, std::uint32_t slot = 0);

  const ilk_config_t config_;
  plant::Random random_;
  std::array<ilk_request_t, kMostRequests> requests_{};
  std::size_t count_ = 0;
  std::array<Intent, ILK_SLOTS> intents_{};
  std::uint32_t generation_ = 1;
  std::uint32_t sequence_ = 0;
  std::uint32_t holder_ = 1;
  std::uint32_t consent_ = 0; /**< of the press that it sees */
  std::uint32_t heartbeat_tick_ = 0;
  std::uint32_t next_heartbeat_ = 0;
  bool foot_down_ = false;
  bool was_in_motion_ = false;
  Manner manner_;
  bool is_hasty_;                /**< each press is over after some ticks */
  bool stands_at_zero_;          /**< nothing has moved yet from where a steady robot begins */
  std::uint32_t foot_ticks_ = 0; /**< until the foot changes its mind */
  std::uint32_t lifted_ticks_ = 0;
  std::uint32_t silent_ticks_ = 0;
  std::uint32_t lying_ticks_ = 0;
  std::uint32_t flooding_ticks_ = 0;
};

}  // namespace interlock::campaign

#endif
