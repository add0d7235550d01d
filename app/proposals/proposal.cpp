#include "proposals/proposal.hpp"

namespace interlock {

std::string_view state_name(ProposalState state) noexcept {
  switch (state) {
    case ProposalState::drafted:
      return "drafted";
    case ProposalState::checked:
      return "checked";
    case ProposalState::approved:
      return "approved";
    case ProposalState::executing:
      return "executing";
    case ProposalState::paused:
      return "paused";
    case ProposalState::done:
      return "done";
    case ProposalState::refused:
      return "refused";
    case ProposalState::aborted:
      return "aborted";
    case ProposalState::expired:
      return "expired";
  }
  return "aborted";
}

bool is_open(ProposalState state) noexcept { return state <= ProposalState::paused; }

bool is_approved(ProposalState state) noexcept { return is_open(state) && state >= ProposalState::approved; }

bool may_become(ProposalState from, ProposalState to) noexcept {
  switch (to) {
    case ProposalState::drafted:
      return false;
    case ProposalState::checked:
      return from == ProposalState::drafted;
    case ProposalState::approved:
      return from == ProposalState::checked;
    case ProposalState::executing:
      return from == ProposalState::approved || from == ProposalState::paused;
    case ProposalState::paused:
      return from == ProposalState::approved || from == ProposalState::executing;
    case ProposalState::done:
    case ProposalState::expired:
      return is_approved(from);
    case ProposalState::refused:
    case ProposalState::aborted:
      return is_open(from);
  }
  return false;
}

}  // namespace interlock
