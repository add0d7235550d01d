#include "proposals/motion_registry.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "motion/axis_plan.hpp"
#include "motion/setpoint_range.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"
#include "proposals/proposal_json.hpp"

namespace interlock {

namespace {

/** For somebody to look at what a file asks for. */
constexpr std::chrono::minutes approval_wait{10};

Refusal overloaded(const std::string& next_step) {
  return {"OVERLOADED", "The control thread takes no more commands now.", "", next_step};
}

/** Whether positions of an axis still mean the same place: its counter and its position went the same way. */
bool keeps_reference(const ilk_axis_config_t& rules, const ilk_axis_t& then, const ilk_axis_t& now) {
  const std::uint32_t counted = now.raw - then.raw;
  const std::uint32_t moved =
      static_cast<std::uint32_t>(now.position_counts) - static_cast<std::uint32_t>(then.position_counts);
  return moved == (rules.direction_correction != 0 ? 0u - counted : counted);
}

}  // namespace

MotionRegistry::MotionRegistry(const Robot& robot, const ilk_config_t& config, Send send, Clock clock)
    : robot_(robot), config_(config), send_(std::move(send)), clock_(std::move(clock)) {}

tl::expected<Proposal, Refusal> MotionRegistry::propose(Task task, const ControlView& view,
                                                        std::chrono::steady_clock::time_point asked) {
  std::vector<std::uint32_t> slots = kind_of(task.work).slots(robot_, task.work);
  for (const std::uint32_t slot : slots) {
    if (robot_.at_slot(slot) == nullptr) {
      return tl::make_unexpected(verdict_refusal(ILK_VERDICT_AXIS, "slot " + std::to_string(slot)));
    }
  }
  Proposal& proposal = keep(std::move(task), std::move(slots), view);
  if (const auto checked = check(proposal, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  if (approves(proposal)) {
    return check_still()
        .map_error([&](const Refusal& refusal) { return refuse(proposal, refusal); })
        .and_then([&] { return approve(proposal, asked); });
  }
  become(proposal, ProposalState::checked, "Every check passed. Waits for somebody to approve it.");
  return proposal;
}

bool MotionRegistry::renew(std::uint32_t id) {
  const Proposal* proposal = find(id);
  const MoveTask* move = proposal == nullptr ? nullptr : proposal->work<MoveTask>();
  return move != nullptr && move->jog && is_open(proposal->state) && send_(Renewal{id, {}});
}

bool MotionRegistry::show_image(const NeedleImage& image) {
  const Proposal* open = open_biopsy();
  return open != nullptr && send_(SeenImage{open->id, image});
}

/** An axis that is not where it was then. */
const Axis* MotionRegistry::moved_since(std::span<const AxisCounts> then, const ControlView& view) const {
  const auto moved = std::ranges::find_if(then, [&](const AxisCounts& each) {
    const std::int32_t now = view.snapshot.state.axis[each.slot].position_counts;
    return distance(now, each.counts) > rest_tolerance_counts(config_.axis[each.slot]);
  });
  return moved == then.end() ? nullptr : robot_.at_slot(moved->slot);
}

/** Refuses what followed from targeting that has changed since, or from where axes do not stand any more. */
tl::expected<void, Refusal> MotionRegistry::check_current(const Task& task, const ControlView& view) const {
  if (const Axis* moved = moved_since(task.rests_on, view)) {
    return tl::make_unexpected(Refusal{
        "STALE", capital(title_of(robot_, moved->slot)) + " was moved meanwhile.",
        "axes where they stood when it was proposed", "Look where the robot stands, and propose again."});
  }
  if (task.targeting_revision && *task.targeting_revision != targeting_revision_) {
    return tl::make_unexpected(Refusal{"STALE", "Registration, probe or target changed meanwhile.",
                                       "the present registration, probe and target",
                                       "Look at them, and propose again."});
  }
  return {};
}

/** Refuses a move of one axis beside what moves the robot as a whole. */
tl::expected<void, Refusal> MotionRegistry::check_alone() const {
  if (const Proposal* home = open_home()) {
    return tl::make_unexpected(
        Refusal{"MODE_HOME", "Proposal " + std::to_string(home->id) + " is homing the robot.",
                "no open proposal of homing", "Wait until it has ended, or abort it."});
  }
  if (const Proposal* open = open_mode()) {
    return tl::make_unexpected(
        Refusal{"MODE_PATH",
                "Proposal " + std::to_string(open->id) + " moves " +
                    (open->slots.size() == 1 ? open->axis : std::string("several axes")) + ".",
                "no open proposal of another mode", "Wait until it has ended, or abort it."});
  }
  return {};
}

tl::expected<void, Refusal> MotionRegistry::check_still() const {
  if (scanning_) {
    return tl::make_unexpected(Refusal{"SCANNING", "The robot is held still for a scan.", "no scan",
                                       "Wait for its end, or end it in the console; then ask again."});
  }
  return {};
}

std::vector<AxisCounts> MotionRegistry::headed() const {
  std::vector<AxisCounts> targets;
  for (const Proposal& each : registry_) {
    if (const MoveTask* move = each.work<MoveTask>(); move != nullptr && is_approved(each.state)) {
      targets.push_back({move->slot, move->target_counts});
    }
  }
  return targets;
}

/** From where the axes are now. Keeps what the checks found and against what; refuses the proposal when one
 * failed. */
tl::expected<void, Refusal> MotionRegistry::check(Proposal& proposal, const ControlView& view) {
  CheckList checks;
  if (proposal.task->targeting_revision || !proposal.task->rests_on.empty()) {
    checks.make(CheckName::targeting, [&] { return check_current(*proposal.task, view); });
  }
  const MotionKind& kind = kind_of(proposal.task->work);
  if (kind.yields()) {
    checks.make(CheckName::other_motion, [&] { return check_alone(); });
  }
  kind.check({robot_, config_, view, headed()}, proposal, checks);
  proposal.checks = checks.results();
  proposal.checked_against = std::make_shared<const ilk_snapshot_t>(view.snapshot);
  return checks.outcome().map_error([&](const Refusal& refusal) { return refuse(proposal, refusal); });
}

/** The proposal that waits for approval under that number. */
tl::expected<Proposal*, Refusal> MotionRegistry::waiting(std::uint32_t id) {
  Proposal* proposal = find_mutable(id);
  if (proposal == nullptr || proposal->state != ProposalState::checked) {
    const std::string state = proposal == nullptr ? "unknown" : std::string(state_name(proposal->state));
    return tl::make_unexpected(Refusal{"NOT_WAITING", "Proposal " + std::to_string(id) + " is " + state + ".",
                                       "a proposal that is checked", "Propose it again."});
  }
  return proposal;
}

tl::expected<Proposal, Refusal> MotionRegistry::approve(std::uint32_t id, const ControlView& view,
                                                        std::chrono::steady_clock::time_point asked) {
  discard_waiting(view);
  if (const auto still = check_still(); !still) {
    return tl::make_unexpected(still.error());
  }
  return waiting(id).and_then([&](Proposal* proposal) {
    // One axis goes straight to where it comes to rest, and homing to the switches, from wherever it is.
    const bool has_way = proposal->ends.size() > 1;
    const Axis* moved = has_way ? moved_since(places(*proposal), view) : nullptr;
    return check(*proposal, view).and_then([&]() -> tl::expected<Proposal, Refusal> {
      if (moved != nullptr) {
        const std::string title = capital(title_of(robot_, moved->slot));
        become(
            *proposal, ProposalState::checked,
            title +
                " was moved since it was planned, so it was planned anew. Waits for somebody to approve it.");
        return tl::make_unexpected(Refusal{
            "MOVED", title + " was moved since it was planned; it was planned anew.",
            "axes where they stood when it was planned", "Look at what it does now, then approve it."});
      }
      return approve(*proposal, asked);
    });
  });
}

/** Where the axes stood that it moves, when it was checked last. */
std::vector<AxisCounts> MotionRegistry::places(const Proposal& proposal) {
  std::vector<AxisCounts> places;
  for (const std::uint32_t slot : proposal.slots) {
    places.push_back({slot, proposal.checked_against->state.axis[slot].position_counts});
  }
  return places;
}

tl::expected<Proposal, Refusal> MotionRegistry::confirm(std::uint32_t id, const ControlView& view,
                                                        std::chrono::steady_clock::time_point asked) {
  follow(view);
  if (const auto still = check_still(); !still) {
    return tl::make_unexpected(still.error());
  }
  Proposal* proposal = find_mutable(id);
  if (proposal == nullptr || !proposal->wants_confirmation) {
    return tl::make_unexpected(
        Refusal{"NOT_WAITING", "Proposal " + std::to_string(id) + " waits for no confirmation.",
                "a proposal that is aligned and not yet inserted", "Look where it is."});
  }
  if (!send_(Confirmation{id, 0, asked + approval_timeout})) {
    return tl::make_unexpected(overloaded("Try again."));
  }
  proposal->wants_confirmation = false;
  const TaskStatus waits{
      .task = id, .phase = TaskPhase::paused, .reason = TaskReason::pedal_released, .step = proposal->leg};
  become(*proposal, ProposalState::paused, detail_of(robot_, *proposal, waits, {}));
  return *proposal;
}

tl::expected<Proposal, Refusal> MotionRegistry::reject(std::uint32_t id, const std::string& by) {
  return waiting(id).map([&](Proposal* proposal) {
    become(*proposal, ProposalState::aborted, "Rejected by " + by + " before it was approved.", std::nullopt,
           by);
    return *proposal;
  });
}

/** Whether it needs no click of its own: who moves or homes one axis by hand sees what it does. */
bool MotionRegistry::approves(const Proposal& proposal) const {
  const bool is_of_one_axis = proposal.slots.size() == 1 &&
                              (proposal.work<MoveTask>() != nullptr || proposal.work<HomeTask>() != nullptr);
  const TaskSource source = proposal.task->source;
  return (robot_.auto_approve && source != TaskSource::openigtlink) ||
         (is_of_one_axis && source == TaskSource::console);
}

void MotionRegistry::end_stale(const std::string& by) {
  ++targeting_revision_;
  for (Proposal& each : registry_) {
    const bool is_of_another_case = each.task->case_number != 0 && each.task->case_number != case_;
    if ((each.task->targeting_revision || is_of_another_case) && is_open(each.state)) {
      const bool waits = each.state == ProposalState::checked || send_(Cancel{each.id});
      become(
          each, ProposalState::aborted,
          std::string(is_of_another_case ? "Its case was suspended or closed; propose it again."
                      : each.work<IdentificationTask>() != nullptr
                          ? "A case was opened, or its registration, probe or target changed: there may be "
                            "a patient now."
                          : "Registration, probe or target changed, from which it followed; propose it "
                            "again.") +
              (waits ? "" : " The control thread takes no commands now: press STOP."),
          std::nullopt, by);
    }
  }
  publish_mode();
}

void MotionRegistry::enter_case(std::int64_t number, const std::string& by) {
  case_ = number;
  end_stale(by);
}

/** Hands the task over; what it replaces ends. */
tl::expected<Proposal, Refusal> MotionRegistry::approve(Proposal& proposal,
                                                        std::chrono::steady_clock::time_point asked) {
  become(proposal, ProposalState::checked, "Every check passed.");
  // Kept before it is handed over: the control thread may take it at once.
  approved_.push_back(proposal.task);
  if (!send_(Approval{proposal.task, 0, asked + approval_timeout, {}})) {
    return tl::make_unexpected(
        refuse(proposal, overloaded("Try again; if it happens again, report it with the log.")));
  }
  replace_open(proposal);
  const Work& work = proposal.task->work;
  const TaskStatus waits{.task = proposal.id, .step = kind_of(work).first_step(work)};
  become(proposal, ProposalState::approved, detail_of(robot_, proposal, waits, {}));
  publish_mode();
  return proposal;
}

Proposal& MotionRegistry::keep(Task task, std::vector<std::uint32_t> slots, const ControlView& view) {
  if (registry_.size() == capacity) {
    forget_one();
  }
  task.id = ++last_id_;
  task.case_number = case_;
  Proposal& proposal = registry_.emplace_back();
  proposal.id = task.id;
  proposal.slots = std::move(slots);
  for (const std::uint32_t slot : proposal.slots) {
    proposal.axes.push_back(robot_.at_slot(slot)->name);
  }
  proposal.axis = proposal.slots.size() == 1 ? proposal.axes.front() : "";
  proposal.task = std::make_shared<const Task>(std::move(task));
  kind_of(proposal.task->work).begin(robot_, proposal);
  proposal.created = clock_();
  proposal.created_tick = view.snapshot.state.system.tick;
  proposal.detail = "Drafted.";
  proposal.changed_by = proposal.task->author;
  listener_(proposal);
  return proposal;
}

/** An ended proposal, or the oldest that waits for approval: at most one an axis is approved. */
void MotionRegistry::forget_one() {
  auto forgotten = std::ranges::find_if(registry_, [](const Proposal& each) { return !is_open(each.state); });
  if (forgotten == registry_.end()) {
    forgotten =
        std::ranges::find_if(registry_, [](const Proposal& each) { return !is_approved(each.state); });
    become(*forgotten, ProposalState::aborted, "Too many newer proposals; propose it again.");
  }
  registry_.erase(forgotten);
}

/** A move replaces the approved one of its axis, homing and a path every approved proposal. */
void MotionRegistry::replace_open(const Proposal& by) {
  for (Proposal& each : registry_) {
    const bool in_the_way = !kind_of(by.task->work).yields() || each.slots == by.slots;
    if (in_the_way && each.id != by.id && is_approved(each.state)) {
      become(each, ProposalState::aborted, "Replaced by proposal " + std::to_string(by.id) + ".",
             std::nullopt, by.task->author);
    }
  }
}

Refusal MotionRegistry::refuse(Proposal& proposal, Refusal refusal) {
  become(proposal, ProposalState::refused, refusal.detail + " " + refusal.next_step, refusal.code);
  return refusal;
}

tl::expected<Proposal, Refusal> MotionRegistry::abort(std::uint32_t id, const std::string& by) {
  Proposal* proposal = find_mutable(id);
  if (proposal == nullptr || !is_open(proposal->state)) {
    const std::string state = proposal == nullptr ? "unknown" : std::string(state_name(proposal->state));
    return tl::make_unexpected(Refusal{"ENDED", "Proposal " + std::to_string(id) + " is " + state + ".",
                                       "a proposal that is approved, executing or paused", "None."});
  }
  if (!send_(Cancel{id})) {
    return tl::make_unexpected(overloaded("Press STOP, or release the pedal."));
  }
  const std::string& author = proposal->task->author;
  const bool is_author = by.empty() || by == author;
  become(*proposal, ProposalState::aborted, "Ended by " + (is_author ? "its author" : by) + ".", std::nullopt,
         is_author ? author : by);
  publish_mode();
  return *proposal;
}

/** Each by its number too: an approval may have overtaken the STOP on its way to the control thread. */
void MotionRegistry::abort_all(const std::string& reason, const std::string& by) {
  for (Proposal& each : registry_) {
    if (is_open(each.state)) {
      (void)(is_approved(each.state) && send_(Cancel{each.id}));
      become(each, ProposalState::aborted, reason, std::nullopt, by);
    }
  }
  publish_mode();
}

void MotionRegistry::lose_author(TaskSource source, const std::string& reason) {
  pause_reason_ = reason;
  for (Proposal& each : registry_) {
    const bool is_told = each.detail.starts_with(reason);
    if (each.state == ProposalState::executing || !is_open(each.state) || is_told) {
      continue;
    }
    if (is_approved(each.state)) {
      become(each, each.state, reason + " " + each.detail);
    } else if (each.task->source == source) {
      become(each, ProposalState::aborted, reason + " Nobody had approved it yet; propose it again.");
    }
  }
  publish_mode();
}

void MotionRegistry::follow(const ControlView& view) {
  discard_waiting(view);
  end_unlinked(view);
  for (const TaskStatus& status : view.tasks) {
    follow(status, view);
  }
  // Nobody else can take a new reference of one that only this holds.
  std::erase_if(approved_, [](const TaskReference& each) { return each.use_count() == 1; });
  publish_mode();
}

/** A task is reported anew within a state too: the step changes, or what is left of it. One that has ended
 * here ends on the control thread as well, for as long as that shows it open. */
void MotionRegistry::follow(const TaskStatus& status, const ControlView& view) {
  Proposal* proposal = find_mutable(status.task);
  if (proposal == nullptr || !is_open(proposal->state)) {
    (void)(is_open(status.phase) && send_(Cancel{status.task}));
    return;
  }
  proposal->wants_confirmation =
      status.phase == TaskPhase::paused && status.reason == TaskReason::unconfirmed;
  const ProposalState state = state_of(status.phase);
  std::string detail = detail_of(robot_, *proposal, status, view.biopsy);
  const bool same = proposal->state == state;
  if (same ? proposal->detail.ends_with(detail) : !may_become(proposal->state, state)) {
    return;
  }
  kind_of(proposal->task->work).follow({robot_, config_, view, headed()}, status, *proposal);
  become(*proposal, state, std::move(detail), verdict_of(status));
}

/** What waits for approval is discarded by a lock, as all that was approved is, and by another reference of
 * one of its axes; and it does not wait for ever. */
void MotionRegistry::discard_waiting(const ControlView& view) {
  const bool locked = view.attached && view.snapshot.state.system.mode == ILK_MODE_LOCKED;
  for (Proposal& each : registry_) {
    if (each.state != ProposalState::checked) {
      continue;
    }
    const auto moved = std::ranges::find_if(each.slots, [&](std::uint32_t slot) {
      return !keeps_reference(config_.axis[slot], each.checked_against->state.axis[slot],
                              view.snapshot.state.axis[slot]);
    });
    if (locked) {
      become(each, ProposalState::aborted, "The kernel locked before it was approved; propose it again.");
    } else if (moved != each.slots.end()) {
      become(each, ProposalState::aborted,
             "The home position of " + title_of(robot_, *moved) +
                 " changed before it was approved; propose it again.");
    } else if (clock_() - each.created > approval_wait) {
      become(each, ProposalState::expired, "Nobody approved it within 10 minutes; propose it again.");
    }
  }
}

/** The linked slider, moved by somebody else, whose position does not mean what it meant when the proposal
 * was checked. */
std::optional<std::uint32_t> MotionRegistry::lost_link(const Proposal& proposal,
                                                       const ControlView& view) const {
  for (const std::uint32_t slot : proposal.slots) {
    const auto other = linked_to(robot_, slot);
    if (!other || std::ranges::find(proposal.slots, *other) != proposal.slots.end()) {
      continue;
    }
    const ilk_axis_t& then = proposal.checked_against->state.axis[*other];
    const ilk_axis_t& now = view.snapshot.state.axis[*other];
    if (then.homed != now.homed || !keeps_reference(config_.axis[*other], then, now)) {
      return other;
    }
  }
  return std::nullopt;
}

/** What was approved ends when the slider that its own is linked to gets another home, or loses it: how near
 * both may come was judged by the one before. */
void MotionRegistry::end_unlinked(const ControlView& view) {
  for (Proposal& each : registry_) {
    if (!view.attached || !is_approved(each.state)) {
      continue;
    }
    if (const auto other = lost_link(each, view); other && send_(Cancel{each.id})) {
      become(each, ProposalState::aborted,
             "The home position of " + title_of(robot_, *other) +
                 " changed, whose linkage bounds this motion; propose it again.");
    }
  }
}

void MotionRegistry::become(Proposal& proposal, ProposalState state, std::string detail,
                            std::optional<std::string> verdict, const std::string& by) {
  if (state == ProposalState::executing) {
    pause_reason_.clear();
  } else if (state == ProposalState::paused && proposal.state == ProposalState::executing &&
             !pause_reason_.empty()) {
    detail = pause_reason_ + " " + detail;
  }
  proposal.state = state;
  proposal.detail = std::move(detail);
  proposal.verdict = std::move(verdict);
  const bool is_ended = state == ProposalState::aborted || state == ProposalState::expired;
  proposal.changed_by = !by.empty() ? by : is_ended ? "app" : proposal.task->author;
  if (!is_open(state)) {
    proposal.wants_confirmation = false;
    proposal.ended = clock_();
    proposal.step.clear();
    if (auto remains = kind_of(proposal.task->work).remains(proposal.task->work)) {
      Task ended = *proposal.task;
      ended.work = std::move(*remains);
      proposal.task = std::make_shared<const Task>(std::move(ended));
    }
  }
  listener_(proposal);
}

void MotionRegistry::publish_mode() {
  const std::string_view mode = app_mode();
  if (std::exchange(told_mode_, mode) != mode) {
    mode_listener_(mode);
  }
}

std::string_view MotionRegistry::app_mode() const {
  if (open_home() != nullptr) {
    return RobotMode::home.name;
  }
  const Proposal* open = open_mode();
  return (open == nullptr ? RobotMode::manual : open->task->mode).name;
}

const Proposal* MotionRegistry::open_mode() const {
  const auto found = std::find_if(registry_.begin(), registry_.end(), [](const Proposal& each) {
    return each.task->mode.moves_the_whole() && is_approved(each.state);
  });
  return found == registry_.end() ? nullptr : &*found;
}

const Proposal* MotionRegistry::open_biopsy() const {
  const Proposal* open = open_mode();
  return open != nullptr && open->work<BiopsyTask>() != nullptr ? open : nullptr;
}

const Proposal* MotionRegistry::open_home() const {
  const auto found = std::find_if(registry_.begin(), registry_.end(), [](const Proposal& each) {
    return each.work<HomeTask>() != nullptr && is_approved(each.state);
  });
  return found == registry_.end() ? nullptr : &*found;
}

bool MotionRegistry::may_move() const {
  return std::ranges::any_of(registry_, [](const Proposal& each) { return is_approved(each.state); });
}

bool MotionRegistry::homes(std::uint32_t slot) const {
  const Proposal* home = open_home();
  return home != nullptr && std::find(home->slots.begin(), home->slots.end(), slot) != home->slots.end();
}

const Proposal* MotionRegistry::find(std::uint32_t id) const {
  const auto found =
      std::find_if(registry_.begin(), registry_.end(), [id](const Proposal& each) { return each.id == id; });
  return found == registry_.end() ? nullptr : &*found;
}

Proposal* MotionRegistry::find_mutable(std::uint32_t id) {
  return const_cast<Proposal*>(std::as_const(*this).find(id));
}

const Proposal* MotionRegistry::open_of(std::uint32_t slot) const {
  const auto found = std::find_if(registry_.begin(), registry_.end(), [slot](const Proposal& each) {
    return each.work<MoveTask>() != nullptr && each.slots.front() == slot && is_open(each.state);
  });
  return found == registry_.end() ? nullptr : &*found;
}

}  // namespace interlock
