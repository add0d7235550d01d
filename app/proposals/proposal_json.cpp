#include "proposals/proposal_json.hpp"

#include <nlohmann/json.hpp>

#include "control/frequency_map.hpp"

namespace interlock {

namespace {

/** What only a path has. */
void add_path(nlohmann::json& json, const Proposal& proposal) {
  nlohmann::json ends = nlohmann::json::array();
  for (const AxisCounts& end : proposal.ends) {
    ends.push_back({{"slot", end.slot}, {"target_counts", end.counts}});
  }
  json["mode"] = mode_name(proposal.path.mode);
  json["legs"] = proposal.path.program->legs.size();
  json["leg"] = proposal.leg;
  json["duration_s"] = proposal.duration_s;
  json["ends"] = std::move(ends);
}

/** What only a sweep has. */
void add_sweep(nlohmann::json& json, const Proposal& proposal) {
  const FrequencySteps& steps = proposal.sweep.steps;
  nlohmann::json frequencies = nlohmann::json::array();
  for (std::uint32_t step = 0; step < steps.count; ++step) {
    nlohmann::json row{{"hz", frequency_map::hz_of(steps.word(step))}, {"counts_per_s", nullptr}};
    if (step < proposal.speeds_counts_per_s.size() && proposal.speeds_counts_per_s[step] > 0.0F) {
      row["counts_per_s"] = proposal.speeds_counts_per_s[step];
    }
    frequencies.push_back(std::move(row));
  }
  json["mode"] = mode_name(RobotMode::frequency_sweep);
  json["dwell_ticks"] = steps.dwell_ticks;
  json["frequencies"] = std::move(frequencies);
}

}  // namespace

nlohmann::json to_json(const Proposal& proposal) {
  const bool is_move = proposal.kind == ProposalKind::move;
  nlohmann::json json{{"id", proposal.id},
                      {"kind", kind_name(proposal.kind)},
                      {"slot", nullptr},
                      {"axis", nullptr},
                      {"axes", proposal.axes},
                      {"step", nullptr},
                      {"author", proposal.author},
                      {"source", source_name(source_of(proposal))},
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
  if (proposal.kind == ProposalKind::path) {
    add_path(json, proposal);
  }
  if (proposal.kind == ProposalKind::sweep) {
    add_sweep(json, proposal);
  }
  if (proposal.kind == ProposalKind::biopsy) {
    json["mode"] = mode_name(RobotMode::cooperative_biopsy);
    json["target_mm"] = proposal.biopsy.target_mm;
    if (const auto& scanner_from_guide = proposal.biopsy.scanner_from_guide) {
      const Eigen::Vector3d target = *scanner_from_guide * Eigen::Vector3d(proposal.biopsy.target_mm.data());
      json["target_point"] = {target.x(), target.y(), target.z()};
    }
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
