/**
 * @file
 * One case: kernel core, plant, app and monitors in one process, a tick at a time, with the plan's faults.
 */
#ifndef INTERLOCK_CAMPAIGN_WORLD_HPP
#define INTERLOCK_CAMPAIGN_WORLD_HPP

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "app.hpp"
#include "interlock/types.h"
#include "monitors.h"
#include "plan.hpp"
#include "plant/plant.hpp"
#include "robot.hpp"
#include "stop_clock.hpp"

namespace interlock::campaign {

/** What a campaign counts. Sums of cases do not depend on the order in which they ran. */
struct Totals {
  std::uint64_t ticks = 0;
  std::uint64_t faults_injected = 0;
  std::uint64_t unsafe = 0;
  std::uint64_t late = 0;
  std::uint64_t bit_flips = 0;
  std::uint64_t bit_flips_unsafe = 0;
  std::uint64_t stops_met = 0;    /**< demanded by a fault and met within their time */
  std::uint64_t motion_ticks = 0; /**< in MOTION */
  std::uint64_t driven_axis_ticks = 0;
  std::uint64_t homings = 0; /**< completed at a switch */
  std::uint64_t moves_accepted = 0;
  std::uint64_t requests_refused = 0;
  std::uint64_t configurations_refused = 0; /**< of those that have to be */
  std::uint64_t digest = 0;                 /**< of all outputs; the same seeds give the same sum */
  std::array<std::uint64_t, kFaultKinds> faults_by_kind{};
  std::array<std::uint64_t, ILK_FAULT_COUNT> axis_faults{};
  std::array<std::uint64_t, ILK_CAUSE_COUNT> causes{};
  std::bitset<kFaultKinds * kFaultKinds>
      kind_pairs; /**< that began within a few ticks, the lower kind first */
  std::bitset<kStateBits> state_bits;
  std::bitset<kConfigBits> config_bits;
  std::bitset<kConfigBits> config_bits_driven; /**< flipped while an axis was driven */
  std::bitset<kMoveTicks> estop_ticks;         /**< driven ticks of a press after which E-stop was pulled */
  std::bitset<kMoveTicks> pedal_ticks;         /**< the same of a pedal that was released */

  void add(const Totals& other);
};

/** The first thing that went wrong in a case. */
struct Failure {
  std::uint32_t tick = 0;
  std::string_view clause; /**< of a monitor, or the kind of fault after which a stop was late */
  int axis = kNoAxis;
  std::int64_t found = 0;
  std::int64_t bound = 0;
};

class World {
 public:
  explicit World(const Case& plan);

  /** One tick; what went wrong in it, if anything did. */
  std::optional<Failure> step();

  const Totals& totals() const { return totals_; }
  const ilk_state_t& state() const { return state_; }
  const ilk_outputs_t& outputs() const { return outputs_; }

  /** What the newest tick handed to the kernel. */
  const ilk_config_t& config() const { return config_; }
  const ilk_inputs_t& inputs() const { return inputs_; }
  std::span<const ilk_request_t> requests() const { return app_.requests(); }

  double true_position(std::size_t slot) const { return plant_.station(slot)->position_counts(); }

 private:
  void inject_what_is_due();
  bool is_due(const Fault& fault) const;
  void note_swept_tick(FaultKind kind);
  void inject(const Fault& fault);
  void note_pairs(FaultKind kind);
  void inject_pedal(const Fault& fault);
  bool another_holds_the_pedal() const;
  void inject_card(const Fault& fault);
  void inject_axis(const Fault& fault);
  void inject_switch(const Fault& fault);
  void inject_app(const Fault& fault);
  void inject_memory(const Fault& fault);
  void demand(std::uint32_t within, int axis, FaultKind kind);
  void act(const plant::command::Command& command, std::uint32_t after = 0);
  void break_promise(std::size_t slot, std::uint32_t ticks);
  void renew_promises();
  void exchange();
  void spoil_inputs();
  void run_kernel();
  void sweep_flips(const ilk_state_t& before);
  void begin_anew();
  void forget();
  void count();
  std::optional<Failure> judge();
  std::optional<Failure> judge_memory() const;
  std::optional<Failure> judge_range();

  Case plan_;
  plant::Random random_;
  Robot robot_;
  ilk_config_t config_; /**< as the kernel sees it; may be damaged */
  ilk_state_t state_{};
  ilk_inputs_t inputs_{};
  ilk_outputs_t outputs_{};
  App app_;
  plant::Plant plant_;
  ilk_ghost_t ghost_{};
  ilk_view_t before_{};
  ilk_view_t after_{};
  StopClock clock_;

  std::uint32_t tick_ = 0;
  std::size_t next_fault_ = 0;
  std::vector<std::pair<std::uint32_t, plant::command::Command>> commands_; /**< to the plant, by tick */
  std::vector<Fault> waiting_; /**< their tick is over, but not that of the press */
  std::vector<std::pair<std::uint32_t, FaultKind>> newest_faults_; /**< the last few ticks' */
  std::uint32_t driven_ticks_ = 0;                                 /**< since MOTION was entered */
  bool is_driven_ = false;
  bool foot_was_down_ = false;
  std::uint32_t starts_ = 1; /**< of the kernel; with each it gets another nonce */
  std::uint32_t pedal_held_until_ = 0;
  std::uint32_t undefined_pedal_ticks_ = 0;
  std::uint32_t undefined_estop_ticks_ = 0;
  std::uint32_t overrun_ticks_ = 0;
  std::uint32_t failing_ticks_ = 0;
  std::uint32_t config_damage_ticks_ = 0;
  std::uint32_t config_damage_left_ = 0;
  std::size_t config_bit_ = 0;
  std::optional<std::size_t> state_bit_;
  bool state_damaged_ = false; /**< before this tick */
  std::size_t sweep_bit_;
  std::array<std::uint32_t, ILK_SLOTS> broken_until_{};
  std::array<bool, ILK_SLOTS> broken_{};
  std::array<bool, ILK_SLOTS> inside_{};      /**< homed and within the soft range, since then */
  std::optional<std::string_view> unrefused_; /**< what a kernel did that had to stay in INIT */
  Totals totals_;
};

}  // namespace interlock::campaign

#endif
