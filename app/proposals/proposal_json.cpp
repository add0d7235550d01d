#include "proposals/proposal_json.hpp"

#include <nlohmann/json.hpp>

namespace interlock {

nlohmann::json to_json(const Proposal& proposal) {
  const bool is_move = proposal.kind == ProposalKind::move;
  nlohmann::json json{{"id", proposal.id},
                      {"kind", is_move ? "move" : "home"},
                      {"slot", nullptr},
                      {"axis", nullptr},
                      {"axes", proposal.axes},
                      {"step", nullptr},
                      {"author", proposal.author},
                      {"source", "console"},
                      {"state", state_name(proposal.state)},
                      {"target_counts", nullptr},
                      {"target", nullptr},
                      {"created", iso_8601(proposal.created)},
                      {"created_tick", proposal.created_tick},
                      {"ended", nullptr},
                      {"verdict", nullptr},
                      {"detail", proposal.detail}};
  if (proposal.slots.size() == 1) {
    json["slot"] = proposal.slots.front();
    json["axis"] = proposal.axis;
  }
  if (is_move) {
    json["target_counts"] = proposal.move.target_counts;
    json["target"] = proposal.target;
  }
  if (!proposal.step.empty()) {
    json["step"] = proposal.step;
  }
  if (proposal.move.drive) {
    json["drive"] = *proposal.move.drive;
  }
  if (proposal.ended) {
    json["ended"] = iso_8601(*proposal.ended);
  }
  if (proposal.verdict) {
    json["verdict"] = *proposal.verdict;
  }
  return json;
}

}  // namespace interlock
