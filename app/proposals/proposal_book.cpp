#include "proposals/proposal_book.hpp"

#include <algorithm>
#include <utility>

#include "proposals/home_plan.hpp"
#include "proposals/order_words.hpp"

namespace interlock {
namespace {

Refusal overloaded(const std::string& next_step) {
  return {"OVERLOADED", "The control thread takes no more commands now.", "", next_step};
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
  if (const Proposal* home = open_home()) {
    return tl::make_unexpected(refuse(
        proposal, Refusal{"MODE_HOME", "Proposal " + std::to_string(home->id) + " is homing the robot.",
                          "no open proposal of homing", "Wait until it has ended, or abort it."}));
  }
  const auto checked = check_move(*axis, config_, view, move);
  if (!checked) {
    return tl::make_unexpected(refuse(proposal, checked.error()));
  }
  become(proposal, ProposalState::checked, "Inside the range that the kernel allows now.");
  return approve(proposal, Order{proposal.id, move.slot, move.target_counts, move.drive.value_or(0), 0});
}

tl::expected<Proposal, Refusal> ProposalBook::propose_home(const HomeDraft& home, const ControlView& view) {
  const auto plan = plan_home(robot_, home);
  if (!plan) {
    return tl::make_unexpected(plan.error());
  }
  Proposal drafted;
  drafted.kind = ProposalKind::home;
  drafted.author = home.author;
  drafted.first_step = plan->first_step;
  drafted.step_count = plan->step_count;
  drafted.step = plan->step_count == 0 ? "" : robot_.home_steps[plan->first_step].name;
  Proposal& proposal = draft(std::move(drafted), plan->slots, view);
  const auto checked = check_home(robot_, config_, view, *plan);
  if (!checked) {
    return tl::make_unexpected(refuse(proposal, checked.error()));
  }
  become(proposal, ProposalState::checked, "Every axis may be homed now.");
  return approve(proposal,
                 HomeOrder{proposal.id, plan->first_step, plan->step_count, plan->slots.front(), 0});
}

/** Hands the order over; what it replaces ends. */
tl::expected<Proposal, Refusal> ProposalBook::approve(Proposal& proposal, const Command& order) {
  if (!send_(order)) {
    return tl::make_unexpected(
        refuse(proposal, overloaded("Try again; if it happens again, report it with the log.")));
  }
  replace_open(proposal);
  const bool is_move = proposal.kind == ProposalKind::move;
  become(proposal, ProposalState::approved,
         is_move ? detail_of(OrderStatus{})
                 : detail_of(robot_, proposal, HomeStatus{{}, proposal.first_step, 0, 0}));
  tell_mode();
  return proposal;
}

Proposal& ProposalBook::draft(Proposal proposal, const std::vector<std::uint32_t>& slots,
                              const ControlView& view) {
  if (book_.size() == capacity) {
    // At most one proposal an axis is open, so there is always an ended one to forget.
    book_.erase(
        std::find_if(book_.begin(), book_.end(), [](const Proposal& each) { return !is_open(each.state); }));
  }
  proposal.id = ++last_id_;
  proposal.slots = slots;
  for (const std::uint32_t slot : slots) {
    proposal.axes.push_back(robot_.at_slot(slot)->name);
  }
  proposal.axis = slots.size() == 1 ? proposal.axes.front() : "";
  proposal.created = clock_();
  proposal.created_tick = view.snapshot.state.tick;
  proposal.detail = "Drafted.";
  book_.push_back(std::move(proposal));
  listener_(book_.back());
  return book_.back();
}

/** A move replaces the open one of its axis, homing every open proposal. */
void ProposalBook::replace_open(const Proposal& by) {
  for (Proposal& each : book_) {
    const bool in_the_way = by.kind == ProposalKind::home || each.slots == by.slots;
    if (in_the_way && each.id != by.id && is_open(each.state)) {
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

void ProposalBook::follow(const ControlView& view) {
  for (const OrderStatus& status : view.orders) {
    follow_move(status);
  }
  follow_home(view.home);
  tell_mode();
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
  if (same ? detail == proposal->detail : !may_become(proposal->state, state)) {
    return;
  }
  if (proposal->step_count != 0 && status.step < robot_.home_steps.size()) {
    proposal->step = robot_.home_steps[status.step].name;
  }
  become(*proposal, state, std::move(detail), verdict_of(status.order));
}

void ProposalBook::become(Proposal& proposal, ProposalState state, std::string detail,
                          std::optional<std::string> verdict) {
  proposal.state = state;
  proposal.detail = std::move(detail);
  proposal.verdict = std::move(verdict);
  if (!is_open(state)) {
    proposal.ended = clock_();
    proposal.step.clear();
  }
  listener_(proposal);
}

void ProposalBook::tell_mode() {
  const std::string_view mode = app_mode();
  if (std::exchange(told_mode_, mode) != mode) {
    mode_listener_(mode);
  }
}

std::string_view ProposalBook::app_mode() const { return open_home() == nullptr ? "manual" : "home"; }

const Proposal* ProposalBook::open_home() const {
  const auto found = std::find_if(book_.begin(), book_.end(), [](const Proposal& each) {
    return each.kind == ProposalKind::home && is_approved(each.state);
  });
  return found == book_.end() ? nullptr : &*found;
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
