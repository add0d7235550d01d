#include "proposals/proposal_book.hpp"

#include <algorithm>
#include <utility>

#include "robot/catalog.hpp"

namespace interlock {
namespace {

ProposalState state_of(OrderPhase phase) noexcept {
  switch (phase) {
    case OrderPhase::none:
    case OrderPhase::waiting:
      return ProposalState::approved;
    case OrderPhase::executing:
      return ProposalState::executing;
    case OrderPhase::paused:
      return ProposalState::paused;
    case OrderPhase::done:
      return ProposalState::done;
    case OrderPhase::refused:
      return ProposalState::refused;
    case OrderPhase::aborted:
      return ProposalState::aborted;
    case OrderPhase::expired:
      return ProposalState::expired;
  }
  return ProposalState::aborted;
}

std::string words(catalog::Family family, std::uint32_t code) {
  const catalog::Entry& entry = catalog::entry(family, code);
  return catalog::name(family, code) + ": " + std::string(entry.meaning) + " " + std::string(entry.next_step);
}

std::string detail_of(const OrderStatus& status) {
  switch (status.reason) {
    case OrderReason::none:
      return status.phase == OrderPhase::executing ? "Moves while the pedal is held."
                                                   : "Waits for the pedal.";
    case OrderReason::arrived:
      return "At rest within the deadband of the target.";
    case OrderReason::pedal_released:
      return "Motion ended; press and hold the pedal within 60 s to go on.";
    case OrderReason::kernel_refused:
      return "The kernel refused: " + words(catalog::Family::verdict, status.code);
    case OrderReason::stopped:
      return "STOP.";
    case OrderReason::cancelled:
      return "Ended by its author.";
    case OrderReason::locked:
      return "The kernel locked. " + words(catalog::Family::cause, status.code);
    case OrderReason::axis_disabled:
      return "The axis was disabled.";
    case OrderReason::axis_homing:
      return "Homing took over the axis.";
    case OrderReason::axis_faulted:
      return "The axis faulted. " + words(catalog::Family::fault, status.code);
    case OrderReason::blocked:
      return "A limit held the axis back. " + words(catalog::Family::gate, status.code);
    case OrderReason::link_lost:
      return "The link to the kernel was lost.";
    case OrderReason::waited_too_long:
      return "The pedal was not held for 60 s; propose the move again.";
  }
  return "";
}

std::optional<std::string> verdict_of(const OrderStatus& status) {
  switch (status.reason) {
    case OrderReason::kernel_refused:
      return catalog::name(catalog::Family::verdict, status.code);
    case OrderReason::axis_faulted:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_FAULTED);
    case OrderReason::axis_disabled:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_DISABLED);
    case OrderReason::axis_homing:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_BUSY);
    case OrderReason::locked:
      return catalog::name(catalog::Family::verdict, ILK_VERDICT_MODE);
    default:
      return std::nullopt;
  }
}

}  // namespace

ProposalBook::ProposalBook(const Robot& robot, const ilk_config_t& config, Send send, Clock clock)
    : robot_(robot), config_(config), send_(std::move(send)), clock_(std::move(clock)) {}

tl::expected<Proposal, Refusal> ProposalBook::propose(const MoveDraft& move, const ControlView& view) {
  const Axis* axis = robot_.at_slot(move.slot);
  if (axis == nullptr) {
    return tl::make_unexpected(verdict_refusal(ILK_VERDICT_AXIS, "slot " + std::to_string(move.slot)));
  }
  Proposal& proposal = draft(*axis, move, view.snapshot.state.tick);
  const auto checked = check_move(*axis, config_, view, move);
  if (!checked) {
    return tl::make_unexpected(refuse(proposal, checked.error()));
  }
  become(proposal, ProposalState::checked, "Inside the range that the kernel allows now.");
  if (!send_(Order{proposal.id, move.slot, move.target_counts, move.drive.value_or(0), 0})) {
    return tl::make_unexpected(
        refuse(proposal, Refusal{"OVERLOADED", "The control thread takes no more commands now.", "",
                                 "Try again; if it happens again, report it with the log."}));
  }
  replace_open(move.slot, proposal.id);
  become(proposal, ProposalState::approved, "Waits for the pedal.");
  return proposal;
}

Proposal& ProposalBook::draft(const Axis& axis, const MoveDraft& move, std::uint32_t tick) {
  if (book_.size() == capacity) {
    // At most one proposal an axis is open, so there is always an ended one to forget.
    book_.erase(
        std::find_if(book_.begin(), book_.end(), [](const Proposal& each) { return !is_open(each.state); }));
  }
  Proposal proposal;
  proposal.id = ++last_id_;
  proposal.move = move;
  proposal.axis = axis.name;
  proposal.target = axis.to_unit(move.target_counts);
  proposal.created = clock_();
  proposal.created_tick = tick;
  proposal.detail = "Drafted.";
  book_.push_back(std::move(proposal));
  listener_(book_.back());
  return book_.back();
}

void ProposalBook::replace_open(std::uint32_t slot, std::uint32_t by) {
  for (Proposal& each : book_) {
    if (each.move.slot == slot && each.id != by && is_open(each.state)) {
      become(each, ProposalState::aborted, "Replaced by proposal " + std::to_string(by) + ".");
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
  if (!send_(Cancel{id, proposal->move.slot})) {
    return tl::make_unexpected(Refusal{"OVERLOADED", "The control thread takes no more commands now.", "",
                                       "Press STOP, or release the pedal."});
  }
  become(*proposal, ProposalState::aborted, "Ended by its author.");
  return *proposal;
}

void ProposalBook::abort_all(const std::string& reason) {
  for (Proposal& each : book_) {
    if (is_open(each.state)) {
      become(each, ProposalState::aborted, reason);
    }
  }
}

void ProposalBook::follow(const OrderTable& orders) {
  for (const OrderStatus& status : orders) {
    follow(status);
  }
}

void ProposalBook::follow(const OrderStatus& status) {
  Proposal* proposal = find_mutable(status.proposal);
  const ProposalState state = state_of(status.phase);
  if (proposal != nullptr && may_become(proposal->state, state)) {
    become(*proposal, state, detail_of(status), verdict_of(status));
  }
}

void ProposalBook::become(Proposal& proposal, ProposalState state, std::string detail,
                          std::optional<std::string> verdict) {
  proposal.state = state;
  proposal.detail = std::move(detail);
  proposal.verdict = std::move(verdict);
  if (!is_open(state)) {
    proposal.ended = clock_();
  }
  listener_(proposal);
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
    return each.move.slot == slot && is_open(each.state);
  });
  return found == book_.end() ? nullptr : &*found;
}

}  // namespace interlock
