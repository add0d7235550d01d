/**
 * @file
 * What the dialects of workphases share: the requests CMD_, CLB_ and TGT_, what is answered to them and in
 * which order, and the phase of one connection.
 *
 * A request's name is four letters and an ID, its acknowledgement "ACK_" and that ID: "I have it", no more.
 * For a phase the order is ACK, CURRENT_STATUS, then the phase's own STATUS. A calibration and a target
 * belong to the connection: after another connect they have to be sent again.
 */
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "igtl/dialect.hpp"
#include "igtl/phase.hpp"

namespace interlock::igtl {

class Workphases : public Dialect {
 public:
  /** A STATUS that takes longer is preceded by one that says so. */
  static constexpr std::chrono::milliseconds longest_silence{4500};
  /** At the target. */
  static constexpr double reached_mm = 0.5;

  Reaction take(const Message& message, const RobotState& state, bool controls) override;
  Outgoings take_broken(const std::string& device, const Status& fault) override;
  Reaction finish(const std::string& device, const Wish& wish, const Outcome& outcome) override;
  Outgoings follow(const Motion& motion, const RobotState& state) override;
  [[nodiscard]] Outgoings told(const RobotState& state) const override;
  Outgoings beat(Time now, const RobotState& state, bool has_to_hear) override;

 protected:
  /** Why the phase may not be entered now; empty: it may. */
  [[nodiscard]] virtual std::string forbids(Phase wanted, const RobotState& state) const = 0;

  /** Whether PLANNING and CALIBRATION have a STATUS of their own on entry. */
  [[nodiscard]] virtual bool tells_every_entry() const noexcept = 0;

  /** Of TARGETING without a calibration. */
  [[nodiscard]] virtual StatusCode uncalibrated() const noexcept = 0;

  /** Whether a target out of reach is replaced by what can be reached. */
  [[nodiscard]] virtual bool takes_reachable() const noexcept = 0;

  /** Whether a target may be sent in this phase. */
  [[nodiscard]] virtual bool takes_target() const noexcept = 0;

  /** What follows a calibration or a target that was stored. */
  [[nodiscard]] virtual Outgoings after_storing(const Outcome& outcome) const;

  /** A message of no common name: refused, unless the dialect knows it. */
  virtual Reaction take_other(const Message& message, const RobotState& state);

  /** A wish of `take_other` was carried out or refused. */
  virtual Reaction finish_other(const Wish& wish, const Outcome& outcome);

  /** What it moves for. */
  enum class Aim : std::uint8_t { nothing, start_up, target, retraction };

  /** A message that is refused, in a STATUS of that name. */
  [[nodiscard]] static Reaction refuse(const std::string& name, StatusCode code, const std::string& reason,
                                       std::int64_t sub_code = 0);

  /** Of the STATUS that says how a motion ended. */
  [[nodiscard]] static std::string name_of(Aim aim);

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] Phase phase_before() const noexcept { return before_; }
  [[nodiscard]] bool has_target() const noexcept { return has_target_; }
  [[nodiscard]] Aim aim() const noexcept { return aim_; }

  /** Wishes for a motion, in place of the one before. */
  void aim_for(Aim aim, Wish wish, Reaction& reaction);

  /** Says what became of a wish for motion, unless it became a proposal, whose end says it. */
  Reaction settle(Aim aim, const Outcome& outcome);

  /** No motion is waited for any more. */
  void drop_motion(Reaction& reaction);

 private:
  Reaction take_request(const Message& message, const RobotState& state, bool controls);
  [[nodiscard]] bool is_repeated(const Message& message) const;
  [[nodiscard]] Reaction repeat(const Message& message) const;
  void remember(const Message& message);
  Reaction request(const std::string& id, const Message& message, const RobotState& state, bool controls);
  void enter(Phase phase, Reaction& reaction);
  Reaction calibrate(const std::string& id, const Message& message);
  Reaction target(const std::string& id, const Message& message);
  Reaction finish_calibration(const Outcome& outcome);
  Reaction finish_target(const SetTargetPose& wish, const Outcome& outcome);
  [[nodiscard]] Status current_status(StatusCode code, std::string text = {}) const;
  [[nodiscard]] Outgoings known(const RobotState& state) const;

  std::deque<Outgoing> taken_; /**< the last requests that were taken, newest last */
  Phase phase_ = Phase::undefined;
  Phase before_ = Phase::undefined; /**< the phase from which STOP or EMERGENCY came */
  bool calibrated_ = false;
  bool has_target_ = false;
  Aim aim_ = Aim::nothing;
  std::optional<std::uint32_t> motion_; /**< proposal of `aim_` */
  /** Each STATUS that is waited for, since when; empty: since the last beat. */
  std::map<std::string, std::optional<Time>> expected_;
};

}  // namespace interlock::igtl
