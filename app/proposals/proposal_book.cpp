#include "proposals/proposal_book.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "proposals/biopsy_check.hpp"
#include "proposals/order_words.hpp"
#include "proposals/sweep_check.hpp"

namespace interlock {
namespace {

/** For somebody to look at what a file asks for. */
constexpr std::chrono::minutes approval_wait{10};

Refusal overloaded(const std::string& next_step) {
  return {"OVERLOADED", "The control thread takes no more commands now.", "", next_step};
}

/** The axes of a mask, in the order in which people see them. */
std::vector<std::uint32_t> slots_of(const Robot& robot, std::uint32_t mask) {
  std::vector<std::uint32_t> slots;
  for (const Axis& axis : robot.axes) {
    if (((mask >> axis.slot) & 1u) != 0) {
      slots.push_back(axis.slot);
    }
  }
  return slots;
}

}  // namespace

ProposalBook::ProposalBook(const Robot& robot, const ilk_config_t& config, Send send, Clock clock)
    : robot_(robot), config_(config), send_(std::move(send)), clock_(std::move(clock)) {}

tl::expected<Proposal, Refusal> ProposalBook::propose(const MoveDraft& move, const ControlView& view) {
  const Axis* axis = robot_.at_slot(move.slot);
  if (axis == nullptr) {
    return tl::make_unexpected(verdict_refusal(ILK_VERDICT_AXIS, "slot " + std::to_string(move.slot)));
  }
  Proposal drafted;
  drafted.move = move;
  drafted.author = move.author;
  drafted.target = axis->to_unit(move.target_counts);
  Proposal& proposal = draft(std::move(drafted), {move.slot}, view);
  CheckList checks;
  checks.make(CheckName::other_motion, [&] { return check_alone(); });
  check_move(*axis, config_, view, move, checks);
  if (const auto checked = take_checks(proposal, checks, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  become(proposal, ProposalState::checked, "Inside the range that the kernel allows now.");
  return approve(proposal, Order{proposal.id, move.slot, move.target_counts, move.drive.value_or(0), 0,
                                 move.held ? std::optional(Moment{}) : std::nullopt});
}

tl::expected<Proposal, Refusal> ProposalBook::propose_home(const HomeDraft& home, const ControlView& view) {
  const auto plan = plan_home(robot_, home);
  if (!plan) {
    return tl::make_unexpected(plan.error());
  }
  Proposal drafted;
  drafted.kind = ProposalKind::home;
  drafted.home = home;
  drafted.author = home.author;
  drafted.first_step = plan->first_step;
  drafted.step_count = plan->step_count;
  drafted.step = plan->step_count == 0 ? "" : robot_.home_steps[plan->first_step].name;
  Proposal& proposal = draft(std::move(drafted), plan->slots, view);
  if (const auto checked = check_home_of(proposal, *plan, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  if (approves(home.source)) {
    return approve_home(proposal, *plan);
  }
  become(proposal, ProposalState::checked, "Every axis may be homed. Waits for somebody to approve it.");
  return proposal;
}

tl::expected<Proposal, Refusal> ProposalBook::propose_path(const PathDraft& path, const ControlView& view) {
  Proposal drafted;
  drafted.kind = ProposalKind::path;
  drafted.path = path;
  drafted.author = path.author;
  Proposal& proposal = draft(std::move(drafted), slots_of(robot_, path.program->mask()), view);
  if (const auto checked = check(proposal, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  if (approves(path.source)) {
    return approve_path(proposal);
  }
  become(proposal, ProposalState::checked, "Every check passed. Waits for somebody to approve it.");
  return proposal;
}

tl::expected<Proposal, Refusal> ProposalBook::propose_sweep(const SweepDraft& sweep,
                                                            const ControlView& view) {
  if (robot_.at_slot(sweep.slot) == nullptr) {
    return tl::make_unexpected(verdict_refusal(ILK_VERDICT_AXIS, "slot " + std::to_string(sweep.slot)));
  }
  Proposal drafted;
  drafted.kind = ProposalKind::sweep;
  drafted.sweep = sweep;
  drafted.author = sweep.author;
  Proposal& proposal = draft(std::move(drafted), {sweep.slot}, view);
  CheckList checks;
  check_sweep(robot_, config_, view, sweep, checks);
  if (const auto checked = take_checks(proposal, checks, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  become(proposal, ProposalState::checked, "Inside the band of the axis.");
  return approve(proposal, SweepOrder{proposal.id, sweep.slot, sweep.steps, 0});
}

tl::expected<Proposal, Refusal> ProposalBook::propose_biopsy(const BiopsyDraft& biopsy,
                                                             const ControlView& view) {
  Proposal drafted;
  drafted.kind = ProposalKind::biopsy;
  drafted.biopsy = biopsy;
  drafted.author = biopsy.author;
  const std::vector<std::uint32_t> slots{robot_.with_role("insertion")->slot,
                                         robot_.with_role("rotation")->slot};
  Proposal& proposal = draft(std::move(drafted), slots, view);
  CheckList checks;
  if (biopsy.targeting_revision) {
    checks.make(CheckName::targeting, [&] { return check_current(proposal); });
  }
  check_biopsy(robot_, config_, view, biopsy, checks);
  if (const auto checked = take_checks(proposal, checks, view); !checked) {
    return tl::make_unexpected(checked.error());
  }
  become(proposal, ProposalState::checked, "The needle is at the skin, and the hand's force is heard.");
  lent_.push_back({proposal.id, ProposalKind::biopsy, biopsy.run});
  return approve(proposal, BiopsyOrder{proposal.id, biopsy.run.get(), 0});
}

bool ProposalBook::renew(std::uint32_t id) {
  const Proposal* jog = find(id);
  return jog != nullptr && jog->move.held && is_open(jog->state) && send_(Renewal{id, {}});
}

bool ProposalBook::show_image(const NeedleImage& image) {
  const Proposal* open = open_biopsy();
  return open != nullptr && send_(SeenImage{open->id, image});
}

/** Refuses what followed from targeting that has changed since. */
tl::expected<void, Refusal> ProposalBook::check_current(const Proposal& proposal) const {
  const auto revision = interlock::targeting_revision(proposal);
  if (revision && *revision != targeting_revision_) {
    return tl::make_unexpected(Refusal{"STALE", "Registration, probe or target changed meanwhile.",
                                       "the present registration, probe and target",
                                       "Look at them, and propose again."});
  }
  return {};
}

/** Refuses a move of one axis beside what moves the robot as a whole. */
tl::expected<void, Refusal> ProposalBook::check_alone() const {
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

/** Keeps what the checks found and against what; refuses the proposal when one failed. */
tl::expected<void, Refusal> ProposalBook::take_checks(Proposal& proposal, const CheckList& checks,
                                                      const ControlView& view) {
  proposal.checks = checks.results();
  proposal.checked_against = std::make_shared<const ilk_snapshot_t>(view.snapshot);
  return checks.outcome().map_error([&](const Refusal& refusal) { return refuse(proposal, refusal); });
}

/** Checks a path from where the axes are now. */
tl::expected<void, Refusal> ProposalBook::check(Proposal& proposal, const ControlView& view) {
  CheckList checks;
  if (proposal.path.targeting_revision) {
    checks.make(CheckName::targeting, [&] { return check_current(proposal); });
  }
  const auto preview = check_path(robot_, config_, view, *proposal.path.program, checks);
  if (preview) {
    proposal.ends = preview->ends;
    proposal.duration_s = preview->duration_s;
  }
  return take_checks(proposal, checks, view);
}

tl::expected<void, Refusal> ProposalBook::check_home_of(Proposal& proposal, const HomePlan& plan,
                                                        const ControlView& view) {
  CheckList checks;
  check_home(robot_, config_, view, plan, checks);
  return take_checks(proposal, checks, view);
}

/** The proposal that waits for approval under that number. */
tl::expected<Proposal*, Refusal> ProposalBook::waiting(std::uint32_t id) {
  Proposal* proposal = find_mutable(id);
  if (proposal == nullptr || proposal->state != ProposalState::checked) {
    const std::string state = proposal == nullptr ? "unknown" : std::string(state_name(proposal->state));
    return tl::make_unexpected(Refusal{"NOT_WAITING", "Proposal " + std::to_string(id) + " is " + state + ".",
                                       "a proposal that is checked", "Propose it again."});
  }
  return proposal;
}

tl::expected<Proposal, Refusal> ProposalBook::approve(std::uint32_t id, const ControlView& view) {
  const auto found = waiting(id);
  if (!found) {
    return tl::make_unexpected(found.error());
  }
  Proposal& proposal = **found;
  if (proposal.kind != ProposalKind::home) {
    return check(proposal, view).and_then([&] { return approve_path(proposal); });
  }
  const auto plan = plan_home(robot_, proposal.home);
  if (!plan) {
    return tl::make_unexpected(refuse(proposal, plan.error()));
  }
  return check_home_of(proposal, *plan, view).and_then([&] { return approve_home(proposal, *plan); });
}

tl::expected<Proposal, Refusal> ProposalBook::reject(std::uint32_t id, const std::string& by) {
  return waiting(id).map([&](Proposal* proposal) {
    become(*proposal, ProposalState::aborted, "Rejected by " + by + " before it was approved.");
    return *proposal;
  });
}

/** Whether such proposals need no click. */
bool ProposalBook::approves(ProposalSource source) const {
  return source == ProposalSource::console || robot_.auto_approve;
}

tl::expected<Proposal, Refusal> ProposalBook::approve_home(Proposal& proposal, const HomePlan& plan) {
  become(proposal, ProposalState::checked, "Every axis may be homed now.");
  return approve(proposal, HomeOrder{proposal.id, plan.first_step, plan.step_count, plan.slots.front(), 0});
}

tl::expected<Proposal, Refusal> ProposalBook::approve_path(Proposal& proposal) {
  become(proposal, ProposalState::checked, "Every check passed.");
  // Lent before it is handed over: the control thread may take it at once.
  lent_.push_back({proposal.id, ProposalKind::path, proposal.path.program});
  return approve(proposal, PathOrder{proposal.id, proposal.path.program.get(), 0});
}

void ProposalBook::end_stale() {
  ++targeting_revision_;
  for (Proposal& each : book_) {
    if (interlock::targeting_revision(each) && is_open(each.state)) {
      const bool waits = each.state == ProposalState::checked || send_(Cancel{each.id});
      become(each, ProposalState::aborted,
             std::string("Registration, probe or target changed, from which it followed; propose it again.") +
                 (waits ? "" : " The control thread takes no commands now: press STOP."));
    }
  }
  tell_mode();
}

/** Hands the order over; what it replaces ends. */
tl::expected<Proposal, Refusal> ProposalBook::approve(Proposal& proposal, const Command& order) {
  if (!send_(order)) {
    std::erase_if(lent_, [&](const Lent& each) { return each.proposal == proposal.id; });
    return tl::make_unexpected(
        refuse(proposal, overloaded("Try again; if it happens again, report it with the log.")));
  }
  replace_open(proposal);
  const bool homes = proposal.kind == ProposalKind::home;
  become(proposal, ProposalState::approved,
         homes ? detail_of(robot_, proposal, HomeStatus{{}, proposal.first_step, 0, 0})
               : detail_of(OrderStatus{}));
  tell_mode();
  return proposal;
}

Proposal& ProposalBook::draft(Proposal proposal, const std::vector<std::uint32_t>& slots,
                              const ControlView& view) {
  if (book_.size() == capacity) {
    forget_one();
  }
  proposal.id = ++last_id_;
  proposal.slots = slots;
  for (const std::uint32_t slot : slots) {
    proposal.axes.push_back(robot_.at_slot(slot)->name);
  }
  proposal.axis = slots.size() == 1 ? proposal.axes.front() : "";
  proposal.created = clock_();
  proposal.created_tick = view.snapshot.state.system.tick;
  proposal.detail = "Drafted.";
  book_.push_back(std::move(proposal));
  listener_(book_.back());
  return book_.back();
}

/** An ended proposal, or the oldest that waits for approval: at most one an axis is approved. */
void ProposalBook::forget_one() {
  auto forgotten = std::ranges::find_if(book_, [](const Proposal& each) { return !is_open(each.state); });
  if (forgotten == book_.end()) {
    forgotten = std::ranges::find_if(book_, [](const Proposal& each) { return !is_approved(each.state); });
    become(*forgotten, ProposalState::aborted, "Too many newer proposals; propose it again.");
  }
  book_.erase(forgotten);
}

/** A move replaces the approved one of its axis, homing and a path every approved proposal. */
void ProposalBook::replace_open(const Proposal& by) {
  for (Proposal& each : book_) {
    const bool in_the_way = by.kind != ProposalKind::move || each.slots == by.slots;
    if (in_the_way && each.id != by.id && is_approved(each.state)) {
      become(each, ProposalState::aborted, "Replaced by proposal " + std::to_string(by.id) + ".");
    }
  }
}

Refusal ProposalBook::refuse(Proposal& proposal, Refusal refusal) {
  become(proposal, ProposalState::refused, refusal.detail + " " + refusal.next_step, refusal.code);
  return refusal;
}

tl::expected<Proposal, Refusal> ProposalBook::abort(std::uint32_t id) {
  Proposal* proposal = find_mutable(id);
  if (proposal == nullptr || !is_open(proposal->state)) {
    const std::string state = proposal == nullptr ? "unknown" : std::string(state_name(proposal->state));
    return tl::make_unexpected(Refusal{"ENDED", "Proposal " + std::to_string(id) + " is " + state + ".",
                                       "a proposal that is approved, executing or paused", "None."});
  }
  if (!send_(Cancel{id})) {
    return tl::make_unexpected(overloaded("Press STOP, or release the pedal."));
  }
  become(*proposal, ProposalState::aborted, "Ended by its author.");
  tell_mode();
  return *proposal;
}

void ProposalBook::abort_all(const std::string& reason) {
  for (Proposal& each : book_) {
    if (is_open(each.state)) {
      become(each, ProposalState::aborted, reason);
    }
  }
  tell_mode();
}

void ProposalBook::lose_author(ProposalSource source, const std::string& reason) {
  pause_reason_ = reason;
  for (Proposal& each : book_) {
    const bool is_told = each.detail.starts_with(reason);
    if (each.state == ProposalState::executing || !is_open(each.state) || is_told) {
      continue;
    }
    if (is_approved(each.state)) {
      become(each, each.state, reason + " " + each.detail);
    } else if (source_of(each) == source) {
      become(each, ProposalState::aborted, reason + " Nobody had approved it yet; propose it again.");
    }
  }
  tell_mode();
}

void ProposalBook::follow(const ControlView& view) {
  for (const OrderStatus& status : view.orders) {
    follow_move(status);
  }
  follow_home(view.home);
  follow_path(view.path);
  follow_sweep(view.sweep);
  discard_waiting(view);
  follow_biopsy(view.biopsy);
  take_back(view);
  tell_mode();
}

void ProposalBook::take_back(const ControlView& view) {
  std::erase_if(lent_, [&view](const Lent& each) {
    const OrderStatus& order = each.kind == ProposalKind::path ? view.path.order : view.biopsy.order;
    return order.proposal > each.proposal || (order.proposal == each.proposal && !is_open(order.phase));
  });
}

/** What waits for approval is discarded by a lock, as all that was approved is, and does not wait for ever.
 */
void ProposalBook::discard_waiting(const ControlView& view) {
  const bool locked = view.attached && view.snapshot.state.system.mode == ILK_MODE_LOCKED;
  for (Proposal& each : book_) {
    if (each.state == ProposalState::checked && locked) {
      become(each, ProposalState::aborted, "The kernel locked before it was approved; propose it again.");
    } else if (each.state == ProposalState::checked && clock_() - each.created > approval_wait) {
      become(each, ProposalState::expired, "Nobody approved it within 10 minutes; propose it again.");
    }
  }
}

void ProposalBook::follow_path(const PathStatus& status) {
  Proposal* proposal = find_mutable(status.order.proposal);
  const ProposalState state = state_of(status.order.phase);
  if (proposal == nullptr || proposal->kind != ProposalKind::path || !is_open(proposal->state)) {
    return;
  }
  std::string detail = detail_of(robot_, *proposal, status);
  const bool same = proposal->state == state;
  if (same ? proposal->detail.ends_with(detail) : !may_become(proposal->state, state)) {
    return;
  }
  proposal->leg = status.leg;
  become(*proposal, state, std::move(detail), verdict_of(status.order));
}

void ProposalBook::follow_biopsy(const BiopsyStatus& status) {
  Proposal* proposal = find_mutable(status.order.proposal);
  const ProposalState state = state_of(status.order.phase);
  if (proposal == nullptr || proposal->kind != ProposalKind::biopsy || !is_open(proposal->state)) {
    return;
  }
  std::string detail = detail_of(robot_, status);
  const bool same = proposal->state == state;
  if (same ? proposal->detail.ends_with(detail) : !may_become(proposal->state, state)) {
    return;
  }
  become(*proposal, state, std::move(detail), verdict_of(status.order));
}

void ProposalBook::follow_sweep(const SweepStatus& status) {
  Proposal* proposal = find_mutable(status.order.proposal);
  const ProposalState state = state_of(status.order.phase);
  if (proposal == nullptr || proposal->kind != ProposalKind::sweep || !is_open(proposal->state)) {
    return;
  }
  std::string detail = detail_of(robot_, *proposal, status);
  const bool same = proposal->state == state;
  if (same ? proposal->detail.ends_with(detail) : !may_become(proposal->state, state)) {
    return;
  }
  proposal->speeds_counts_per_s.assign(status.counts_per_s.begin(),
                                       status.counts_per_s.begin() + status.step);
  become(*proposal, state, std::move(detail), verdict_of(status.order));
}

void ProposalBook::follow_move(const OrderStatus& status) {
  Proposal* proposal = find_mutable(status.proposal);
  const ProposalState state = state_of(status.phase);
  if (proposal != nullptr && may_become(proposal->state, state)) {
    become(*proposal, state, detail_of(status), verdict_of(status));
  }
}

/** Homing is told anew within a state too: the step changes, or what is left of it. */
void ProposalBook::follow_home(const HomeStatus& status) {
  Proposal* proposal = find_mutable(status.order.proposal);
  const ProposalState state = state_of(status.order.phase);
  if (proposal == nullptr || proposal->kind != ProposalKind::home || !is_open(proposal->state)) {
    return;
  }
  std::string detail = detail_of(robot_, *proposal, status);
  const bool same = proposal->state == state;
  if (same ? proposal->detail.ends_with(detail) : !may_become(proposal->state, state)) {
    return;
  }
  if (proposal->step_count != 0 && status.step < robot_.home_steps.size()) {
    proposal->step = robot_.home_steps[status.step].name;
  }
  become(*proposal, state, std::move(detail), verdict_of(status.order));
}

void ProposalBook::become(Proposal& proposal, ProposalState state, std::string detail,
                          std::optional<std::string> verdict) {
  if (state == ProposalState::executing) {
    pause_reason_.clear();
  } else if (state == ProposalState::paused && proposal.state == ProposalState::executing &&
             !pause_reason_.empty()) {
    detail = pause_reason_ + " " + detail;
  }
  proposal.state = state;
  proposal.detail = std::move(detail);
  proposal.verdict = std::move(verdict);
  if (!is_open(state)) {
    proposal.ended = clock_();
    proposal.step.clear();
    proposal.biopsy.run.reset();  // what the control thread may still use is lent
  }
  listener_(proposal);
}

void ProposalBook::tell_mode() {
  const std::string_view mode = app_mode();
  if (std::exchange(told_mode_, mode) != mode) {
    mode_listener_(mode);
  }
}

std::string_view ProposalBook::app_mode() const {
  if (open_home() != nullptr) {
    return mode_name(RobotMode::home);
  }
  const Proposal* open = open_mode();
  return mode_name(open == nullptr ? RobotMode::manual : robot_mode(*open));
}

const Proposal* ProposalBook::open_mode() const {
  const auto found = std::find_if(book_.begin(), book_.end(), [](const Proposal& each) {
    return robot_mode(each) > RobotMode::home && is_approved(each.state);
  });
  return found == book_.end() ? nullptr : &*found;
}

const Proposal* ProposalBook::open_biopsy() const {
  const Proposal* open = open_mode();
  return open != nullptr && open->kind == ProposalKind::biopsy ? open : nullptr;
}

const Proposal* ProposalBook::open_home() const {
  const auto found = std::find_if(book_.begin(), book_.end(), [](const Proposal& each) {
    return each.kind == ProposalKind::home && is_approved(each.state);
  });
  return found == book_.end() ? nullptr : &*found;
}

bool ProposalBook::may_move() const {
  return std::ranges::any_of(book_, [](const Proposal& each) { return is_approved(each.state); });
}

bool ProposalBook::homes(std::uint32_t slot) const {
  const Proposal* home = open_home();
  return home != nullptr && std::find(home->slots.begin(), home->slots.end(), slot) != home->slots.end();
}

const Proposal* ProposalBook::find(std::uint32_t id) const {
  const auto found =
      std::find_if(book_.begin(), book_.end(), [id](const Proposal& each) { return each.id == id; });
  return found == book_.end() ? nullptr : &*found;
}

Proposal* ProposalBook::find_mutable(std::uint32_t id) {
  return const_cast<Proposal*>(std::as_const(*this).find(id));
}

const Proposal* ProposalBook::open_of(std::uint32_t slot) const {
  const auto found = std::find_if(book_.begin(), book_.end(), [slot](const Proposal& each) {
    return each.kind == ProposalKind::move && each.move.slot == slot && is_open(each.state);
  });
  return found == book_.end() ? nullptr : &*found;
}

}  // namespace interlock
