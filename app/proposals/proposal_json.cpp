#include "proposals/proposal_json.hpp"

#include <nlohmann/json.hpp>

namespace interlock {

nlohmann::json to_json(const Proposal& proposal) {
  nlohmann::json json{{"id", proposal.id},
                      {"kind", "move"},
                      {"slot", proposal.move.slot},
                      {"axis", proposal.axis},
                      {"author", proposal.move.author},
                      {"source", "console"},
                      {"state", state_name(proposal.state)},
                      {"target_counts", proposal.move.target_counts},
                      {"target", proposal.target},
                      {"created", iso_8601(proposal.created)},
                      {"created_tick", proposal.created_tick},
                      {"ended", nullptr},
                      {"verdict", nullptr},
                      {"detail", proposal.detail}};
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
