/**
 * @file
 * The registry of proposals: drafts, checks, approves and follows them, newest 200 kept.
 *
 * Belongs to the network thread. The control thread carries the tasks out; the registry learns from each view
 * where they stand. A state that is final stays final, whatever a late report says.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "proposals/checks.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

class MotionRegistry {
 public:
  static constexpr std::size_t capacity = 200;

  /** Hands a command to the control thread; false when it takes none now. */
  using Send = std::function<bool(const Command&)>;
  /** Told of each proposal that changed. */
  using Listener = std::function<void(const Proposal&)>;
  /** Told of the new mode, a name of robot/modes.hpp. */
  using ModeListener = std::function<void(std::string_view)>;
  /** Tells the time in UTC. */
  using Clock = std::function<UtcTime()>;

  /** `robot` and `config` must outlive the registry. */
  MotionRegistry(const Robot& robot, const ilk_config_t& config, Send send, Clock clock);

  /** Has the next proposal get the number after that one: numbers mean the same for as long as their records
   * are kept, whichever run of the app gave them. */
  void number_after(std::uint32_t last_id) { last_id_ = last_id; }

  /** Has the listener called after each change of a proposal. */
  void on_change(Listener listener) { listener_ = std::move(listener); }

  /** Has the listener called after each change of the robot's mode. */
  void on_mode_change(ModeListener listener) { mode_listener_ = std::move(listener); }

  /**
   * Checks a task and keeps it. A move or the homing of one axis from the console, or any of a robot that
   * approves by itself, is approved, and every other approved proposal that is in its way is aborted; another
   * one waits for `approve`. A move is refused with MODE_HOME while homing is open, with MODE_PATH while
   * another mode is; STALE what followed from targeting that has changed, or from where an
   * axis does not stand any more. A refused task stays in the
   * registry; one for a slot without an axis (AXIS) does not.
   *
   * @param asked when its author asked for it: one that is approved is good for `approval_timeout` from then on
   */
  tl::expected<Proposal, Refusal> propose(
      Task task, const ControlView& view,
      std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now());

  /** Hands an image to the open biopsy; false when none is open, or the control thread takes none now. */
  bool show_image(const NeedleImage& image);

  /** Whoever jogs still holds on; false when no such jog is open, or the control thread takes none now. */
  bool renew(std::uint32_t id);

  /** Checks a proposal that waits for it anew, and approves it: NOT_WAITING when none of that number does,
   * MOVED when an axis of several that it moves is not where it was when the proposal was planned, which is
   * then done anew. */
  tl::expected<Proposal, Refusal> approve(
      std::uint32_t id, const ControlView& view,
      std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now());

  /** Lets a proposal go on that waits for a confirmation: NOT_WAITING when none of that number does. */
  tl::expected<Proposal, Refusal> confirm(
      std::uint32_t id, const ControlView& view,
      std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now());

  /** Ends a proposal that waits for approval, as `by` wants none of it: NOT_WAITING when none of that number
   * waits. */
  tl::expected<Proposal, Refusal> reject(std::uint32_t id, const std::string& by);

  /** For as long as a scan goes on nothing is approved or confirmed: SCANNING. */
  void hold_still(bool scanning) { scanning_ = scanning; }

  /** Counts the changes of registration, probe and target. */
  [[nodiscard]] std::uint32_t targeting_revision() const { return targeting_revision_; }

  /** Registration, probe or target were changed by `by`: ends every open proposal that followed from them. */
  void end_stale(const std::string& by = {});

  /** From now on proposals belong to that case, or to none: 0. Ends every open one of another case, as
   * `end_stale` does. */
  void enter_case(std::int64_t number, const std::string& by);

  /** Ends an open proposal on behalf of `by`, or else of its author; an executing one stops at once. The id
   * must exist. */
  tl::expected<Proposal, Refusal> abort(std::uint32_t id, const std::string& by = {});

  /** Ends every open proposal on behalf of `by`, or else of the app. The caller sees to it that the kernel
   * stops. */
  void abort_all(const std::string& reason, const std::string& by = {});

  /** Whoever proposed from that source is gone. What nobody has approved yet of it ends; whatever is
   * approved, of any source, pauses, and says so. The caller sees to it that the kernel leaves MOTION. */
  void lose_author(TaskSource source, const std::string& reason);

  /** Takes over where the tasks of the control thread stand. */
  void follow(const ControlView& view);

  /** "home" while homing is open, the mode of a path or sweep while it is, else "manual". */
  [[nodiscard]] std::string_view app_mode() const;

  /** The proposal of that number, or null. */
  [[nodiscard]] const Proposal* find(std::uint32_t id) const;

  /** The open move of the axis, or null. */
  [[nodiscard]] const Proposal* open_of(std::uint32_t slot) const;

  /** The open proposal of homing, or null. */
  [[nodiscard]] const Proposal* open_home() const;

  /** The approved proposal of a mode that is neither Manual nor Home, or null. */
  [[nodiscard]] const Proposal* open_mode() const;

  /** The approved proposal of a biopsy, or null. */
  [[nodiscard]] const Proposal* open_biopsy() const;

  /** Whether nothing but the pedal keeps a proposal, of whatever kind, from motion. */
  [[nodiscard]] bool may_move() const;

  /** Whether open homing moves the axis. */
  [[nodiscard]] bool homes(std::uint32_t slot) const;

  /** Newest first. */
  [[nodiscard]] std::vector<Proposal> newest_first() const { return {registry_.rbegin(), registry_.rend()}; }

 private:
  Proposal& keep(Task task, std::vector<std::uint32_t> slots, const ControlView& view);
  tl::expected<Proposal, Refusal> approve(Proposal& proposal, std::chrono::steady_clock::time_point asked);
  [[nodiscard]] static std::vector<AxisCounts> places(const Proposal& proposal);
  [[nodiscard]] const Axis* moved_since(std::span<const AxisCounts> then, const ControlView& view) const;
  [[nodiscard]] tl::expected<void, Refusal> check_current(const Task& task, const ControlView& view) const;
  [[nodiscard]] tl::expected<void, Refusal> check_alone() const;
  [[nodiscard]] std::vector<AxisCounts> headed() const;
  tl::expected<void, Refusal> check(Proposal& proposal, const ControlView& view);
  tl::expected<Proposal*, Refusal> waiting(std::uint32_t id);
  [[nodiscard]] bool approves(const Proposal& proposal) const;
  [[nodiscard]] tl::expected<void, Refusal> check_still() const;
  void forget_one();
  void replace_open(const Proposal& by);
  Refusal refuse(Proposal& proposal, Refusal refusal);
  void become(Proposal& proposal, ProposalState state, std::string detail,
              std::optional<std::string> verdict = std::nullopt, const std::string& by = {});
  void follow(const TaskStatus& status, const ControlView& view);
  void discard_waiting(const ControlView& view);
  void end_unlinked(const ControlView& view);
  [[nodiscard]] std::optional<std::uint32_t> lost_link(const Proposal& proposal,
                                                       const ControlView& view) const;
  void publish_mode();
  Proposal* find_mutable(std::uint32_t id);

  const Robot& robot_;
  const ilk_config_t& config_;
  Send send_;
  Clock clock_;
  Listener listener_ = [](const Proposal&) {};
  ModeListener mode_listener_ = [](std::string_view) {};
  std::string_view told_mode_ = "manual";
  std::deque<Proposal> registry_;       /**< oldest first */
  std::vector<TaskReference> approved_; /**< that the control thread may hold: it must never free one */
  std::string pause_reason_;            /**< of the pause to come, or that lasts */
  std::uint32_t targeting_revision_ = 0;
  std::int64_t case_ = 0; /**< number of the open one */
  bool scanning_ = false;
  std::uint32_t last_id_ = 0;
};

}  // namespace interlock
