/**
 * @file
 * The dialects of workphases: what they share, and the two that are spoken.
 */
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "igtl/dialect.hpp"
#include "igtl/phase.hpp"

namespace interlock::igtl {

/**
 * What the dialects of workphases share: the requests CMD_, CLB_ and TGT_, what is answered to them and in
 * which order, and the phase of one connection.
 *
 * A request's name is four letters and an ID, its acknowledgement "ACK_" and that ID: "I have it", no more.
 * For a phase the order is ACK, CURRENT_STATUS, then the phase's own STATUS. A calibration and a target
 * belong to the connection: after another connect they have to be sent again.
 */
class Workphases : public Dialect {
 public:
  /** A STATUS that takes longer is preceded by one that says so. */
  static constexpr std::chrono::milliseconds longest_silence{4500};
  /** At the target. */
  static constexpr double reached_mm = 0.5;

  Reaction finish(const std::string& device, const Command& command, const Outcome& outcome) override;
  Outgoings follow(const Motion& motion, const RobotState& state) override;
  [[nodiscard]] Outgoings told(const RobotState& state) const override;
  Outgoings heartbeat(Time now, const RobotState& state, bool has_to_hear) override;

 protected:
  Reaction take_named(const Message& message, const RobotState& state, bool controls) override;
  [[nodiscard]] Outgoings refuse_broken(const std::string& device, const Status& fault) const override;
  Reaction stop(StopName name) override;

  /** Why the phase may not be entered now; empty: it may. */
  [[nodiscard]] virtual std::string forbids(Phase desired, const RobotState& state) const = 0;

  /** Whether PLANNING and CALIBRATION have a STATUS of their own on entry. */
  [[nodiscard]] virtual bool tells_every_entry() const noexcept = 0;

  /** Of TARGETING without a calibration. */
  [[nodiscard]] virtual StatusCode uncalibrated() const noexcept = 0;

  /** Whether the STATUS of a target says by a sub-code why it is refused. */
  [[nodiscard]] virtual bool has_sub_codes() const noexcept = 0;

  /** Whether a target may be sent in this phase. */
  [[nodiscard]] virtual bool takes_target() const noexcept = 0;

  /** What follows a calibration that was stored, and a target that was judged. */
  [[nodiscard]] virtual Outgoings after_storing(const Outcome& outcome) const;

  /** A message of no common name: refused, unless the dialect knows it. */
  virtual Reaction take_other(const Message& message, const RobotState& state);

  /** A command of `take_other` was carried out or refused. */
  virtual Reaction finish_other(const Command& command, const Outcome& outcome);

  /** What it moves for. */
  enum class Goal : std::uint8_t { nothing, start_up, target, retraction };

  /** A message that is refused, in a STATUS of that name. */
  [[nodiscard]] static Reaction refuse(const std::string& name, StatusCode code, const std::string& reason,
                                       std::int64_t sub_code = 0);

  /** Of the STATUS that says how a motion ended. */
  [[nodiscard]] static std::string name_of(Goal goal);

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] Phase phase_before() const noexcept { return before_; }
  [[nodiscard]] bool has_target() const noexcept { return has_target_; }
  [[nodiscard]] Goal goal() const noexcept { return goal_; }

  /** Commands for a motion, in place of the one before. */
  void set_goal(Goal goal, Command command, Reaction& reaction);

  /** Reports what became of a requested motion, unless it became a proposal, whose end says it. */
  Reaction settle(Goal goal, const Outcome& outcome);

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
  Reaction finish_target(const Outcome& outcome);
  [[nodiscard]] Status current_status(StatusCode code, std::string text = {}) const;
  [[nodiscard]] Outgoings known(const RobotState& state) const;

  std::deque<Outgoing> taken_; /**< the last requests that were taken, newest last */
  Phase phase_ = Phase::undefined;
  Phase before_ = Phase::undefined; /**< the phase from which STOP or EMERGENCY came */
  bool calibrated_ = false;
  bool has_target_ = false;
  Goal goal_ = Goal::nothing;
  std::optional<std::uint32_t> motion_; /**< proposal of `goal_` */
  /** Each STATUS that is waited for, since when; empty: since the last beat. */
  std::map<std::string, std::optional<Time>> expected_;
};

/**
 * The dialect of the prostate robots' protocol as its public tests have it (2013): any phase may be asked for
 * at any time, and the phase's own STATUS says whether it can be had.
 */
class Brp2013 final : public Workphases {
 protected:
  [[nodiscard]] std::string forbids(Phase desired, const RobotState& state) const override;
  [[nodiscard]] bool tells_every_entry() const noexcept override { return false; }
  [[nodiscard]] StatusCode uncalibrated() const noexcept override { return StatusCode::not_ready; }
  [[nodiscard]] bool has_sub_codes() const noexcept override { return false; }
  [[nodiscard]] bool takes_target() const noexcept override { return phase() == Phase::targeting; }
};

/**
 * The dialect of the later prostate robots and their Slicer module (2024): phases follow each other in a
 * fixed sequence, what can be reached is told of each target, and the needle has requests of its own. Unlike
 * there, a request that is forbidden is answered, and a target that is out of reach is not replaced.
 */
class Wpi2024 final : public Workphases {
 protected:
  [[nodiscard]] std::string forbids(Phase desired, const RobotState& state) const override;
  [[nodiscard]] bool tells_every_entry() const noexcept override { return true; }
  [[nodiscard]] StatusCode uncalibrated() const noexcept override { return StatusCode::access_denied; }
  [[nodiscard]] bool has_sub_codes() const noexcept override { return true; }
  [[nodiscard]] bool takes_target() const noexcept override {
    return phase() == Phase::targeting || phase() == Phase::move_to_target;
  }
  [[nodiscard]] Outgoings after_storing(const Outcome& outcome) const override;
  Reaction take_other(const Message& message, const RobotState& state) override;
  Reaction finish_other(const Command& command, const Outcome& outcome) override;

 private:
  Reaction take_text(const std::string& name, const Text& text, const RobotState& state);
  [[nodiscard]] Reaction position(const RobotState& state) const;
  [[nodiscard]] Reaction needle_length(const Text& text) const;
  Reaction retract();
  Reaction needle_tip(const Message& message) const;
};

}  // namespace interlock::igtl
