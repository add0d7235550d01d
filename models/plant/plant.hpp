/**
 * @file
 * The robot without the robot: cards, axes, pedal, E-stop and lamps behind the simulated bus.
 *
 * A control loop calls `tick` once a period, in-process or through interlock-sim:
 *
 *     Plant plant(robot, default_parameters(robot), seed);
 *     ilk_sim_reply_t seen = plant.tick(exchange);
 *
 * The same robot, parameters, seed, exchanges and commands give the same bits, on every machine. Nothing
 * here allocates after construction.
 */
#ifndef INTERLOCK_PLANT_PLANT_HPP
#define INTERLOCK_PLANT_PLANT_HPP

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "interlock/sim_bus.h"
#include "plant/axis.hpp"
#include "plant/card.hpp"
#include "plant/command.hpp"
#include "plant/force_sensor.hpp"
#include "plant/pedal.hpp"
#include "plant/record.hpp"
#include "plant/schedule.hpp"
#include "plant/surroundings.hpp"

namespace interlock::plant {

/** A card and what hangs on it: an axis, or on a sensor card a force sensor. */
struct Station {
  Card card;
  std::optional<Axis> axis;
  std::optional<ForceSensor> sensor;
  bool has_switch;
  Random switch_bounce;

  double position_counts() const { return axis ? axis->position_counts() : 0; }
  double tool_counts() const { return axis ? axis->tool_counts() : 0; }

  /** The axis of a motor card and its encoder have these parameters from now on. */
  void take(const AxisParameters& parameters) {
    axis->take(parameters);
    card.encoder()->take(parameters);
  }
};

class Plant {
 public:
  /** @param robot as `load_robot` accepts it */
  Plant(const ilk_config_t& robot, const Parameters& parameters, std::uint64_t seed);

  /** From now on the axes touch that. */
  void surround(std::unique_ptr<Surroundings> surroundings) { surroundings_ = std::move(surroundings); }

  /** Null where the axes touch nothing. */
  const Surroundings* surroundings() const { return surroundings_.get(); }

  /** One transaction: due commands act, every input is latched, then the cards hear their frames. */
  ilk_sim_reply_t exchange(const ilk_sim_exchange_t& exchange) noexcept;

  /** Lets plant time pass. Card watchdogs act at their exact moment within it. */
  void advance(Microseconds elapsed) noexcept;

  /** A control period in the simulated clock: `exchange`, then `advance` by one period. */
  ilk_sim_reply_t tick(const ilk_sim_exchange_t& exchange) noexcept;

  /**
   * Has a command act at the given plant tick, or before anything else happens.
   *
   * @return the tick at which it acts; or why it was refused, and then nothing changed
   */
  tl::expected<std::uint64_t, std::string> schedule(const command::Command& command,
                                                    std::optional<std::uint64_t> at = std::nullopt);

  /** Why the robot cannot do what the command asks for; nothing when it can. */
  std::optional<std::string> refusal(const command::Command& command) const;

  /** What a client is told whose tick is over. */
  std::string past_text(std::uint64_t at) const;

  /** Periods since the start; the next exchange in the simulated clock has this number. */
  std::uint64_t ticks() const { return time_ / period_; }
  Microseconds time() const { return time_; }
  Microseconds period() const { return period_; }

  /** Nothing in an empty slot. */
  const std::optional<Station>& station(std::size_t slot) const { return stations_[slot]; }
  const Record& record() const { return record_; }
  const Pedal& pedal() const { return pedal_; }
  bool estop_pulled() const { return !estop_loop_.closed(); }

  /** Whether the kernel gives the amplifiers power, as last commanded. */
  bool power() const { return power_; }

  /** ilk_colour_t by ilk_lamp_t, as last commanded. */
  const std::array<std::uint32_t, ILK_LAMP_COUNT>& lamps() const { return lamps_; }

 private:
  struct Inputs {
    bool pedal_no_closed;
    bool pedal_nc_closed;
    bool estop_loop_closed;
  };

  void run_due_commands();
  Inputs read_inputs();
  void transact(std::size_t slot, const ilk_sim_exchange_t& exchange, ilk_sim_reply_t& reply);
  void record_exchange(const ilk_sim_exchange_t& exchange, const Inputs& inputs);
  void note_inputs(const Inputs& inputs);
  void note_amplifiers();
  void note_silence();
  Microseconds until_next_watchdog(Microseconds longest) const;
  void step(Microseconds elapsed);
  void touch(Microseconds elapsed);

  void apply(const command::PressPedal& wish);
  void apply(const command::StickPedalContact& wish);
  void apply(const command::PullEstop& wish);
  void apply(const command::JamAxis& wish);
  void apply(const command::PushAxis& wish);
  void apply(const command::JumpCounter& wish);
  void apply(const command::RunAway& wish);
  void apply(const command::ReverseMotor& wish);
  void apply(const command::StickEncoder& wish);
  void apply(const command::StickSwitch& wish);
  void apply(const command::ChangeParameters& wish);
  void apply(const command::RestoreParameters& wish);
  void apply(const command::PressSensor& wish);
  void apply(const command::SpoilFrames& wish);
  void apply(const command::ResetCard& wish);
  void apply(const command::PowerCard& wish);
  void apply(const command::FailTransactions& wish);
  void apply(const command::PressHand& wish);
  void apply(const command::ShiftTarget& wish);
  void apply(const command::Clear& wish);

  Microseconds period_;
  Microseconds time_{0};
  std::array<std::optional<Station>, ILK_SLOTS> stations_;
  Pedal pedal_;
  Contact estop_loop_;
  Random contact_bounce_;
  std::array<std::uint32_t, ILK_LAMP_COUNT> lamps_{};
  bool power_ = false;
  std::uint32_t failing_transactions_ = 0;
  Schedule schedule_;
  std::unique_ptr<Surroundings> surroundings_;

  Record record_;
  std::optional<Microseconds> last_exchange_;
  bool silence_noted_ = false;
  bool amplifiers_on_ = false;
  bool seen_pressed_ = false;
  bool seen_estop_ = false;
};

}  // namespace interlock::plant

#endif
