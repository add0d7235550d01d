#include "proposals/proposal_json.hpp"

#include <nlohmann/json.hpp>

#include "proposals/motion_kind.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock {

nlohmann::json to_json(const Proposal& proposal) {
  const Task& task = *proposal.task;
  nlohmann::json json{{"id", proposal.id},
                      {"case", nullptr},
                      {"kind", kind_of(task.work).name()},
                      {"slot", nullptr},
                      {"axis", nullptr},
                      {"axes", proposal.axes},
                      {"step", nullptr},
                      {"author", task.author},
                      {"source", source_name(task.source)},
                      {"state", state_name(proposal.state)},
                      {"wants_confirmation", proposal.wants_confirmation},
                      {"target_counts", nullptr},
                      {"target", nullptr},
                      {"aim", nullptr},
                      {"created", iso_8601(proposal.created)},
                      {"created_tick", proposal.created_tick},
                      {"ended", nullptr},
                      {"verdict", nullptr},
                      {"detail", proposal.detail}};
  if (task.case_number != 0) {
    json["case"] = task.case_number;
  }
  if (proposal.slots.size() == 1) {
    json["slot"] = proposal.slots.front();
    json["axis"] = proposal.axis;
  }
  if (task.aim) {
    json["aim"] = {{"desired", row_major(task.aim->desired)},
                   {"reachable", row_major(task.aim->reachable)},
                   {"deviation", to_json(deviation(task.aim->reachable, task.aim->desired))}};
    add_error_budget(json["aim"], task.aim->error_budget);
  }
  if (task.mode.moves_the_whole()) {
    json["mode"] = task.mode.name;
  }
  kind_of(task.work).add_fields(proposal, json);
  if (proposal.ended) {
    json["ended"] = iso_8601(*proposal.ended);
  }
  if (proposal.verdict) {
    json["verdict"] = *proposal.verdict;
  }
  return json;
}

}  // namespace interlock
