#include "proposals/proposal_json.hpp"

#include <nlohmann/json.hpp>

#include "control/frequency_map.hpp"

namespace interlock {

namespace {

/** What only a path has. */
void add(nlohmann::json& json, const Proposal& proposal, const PathTask& path) {
  nlohmann::json ends = nlohmann::json::array();
  for (const AxisCounts& end : proposal.ends) {
    ends.push_back({{"slot", end.slot}, {"target_counts", end.counts}});
  }
  json["legs"] = path.program->legs.size();
  json["leg"] = proposal.leg;
  json["duration_s"] = proposal.duration_s;
  json["ends"] = std::move(ends);
}

/** What only a sweep has. */
void add(nlohmann::json& json, const Proposal& proposal, const SweepTask& sweep) {
  nlohmann::json frequencies = nlohmann::json::array();
  for (std::uint32_t step = 0; step < sweep.steps.count; ++step) {
    nlohmann::json row{{"hz", frequency_map::hz_of(sweep.steps.word(step))}, {"counts_per_s", nullptr}};
    if (step < proposal.speeds_counts_per_s.size() && proposal.speeds_counts_per_s[step] > 0.0F) {
      row["counts_per_s"] = proposal.speeds_counts_per_s[step];
    }
    frequencies.push_back(std::move(row));
  }
  json["dwell_ticks"] = sweep.steps.dwell_ticks;
  json["frequencies"] = std::move(frequencies);
}

/** What only a biopsy has. */
void add(nlohmann::json& json, const Proposal& /*proposal*/, const BiopsyTask& insertion) {
  json["target_mm"] = insertion.target_mm;
  if (const auto& scanner_from_guide = insertion.scanner_from_guide) {
    const Eigen::Vector3d target = *scanner_from_guide * Eigen::Vector3d(insertion.target_mm.data());
    json["target_point"] = {target.x(), target.y(), target.z()};
  }
}

/** What only a move has. */
void add(nlohmann::json& json, const Proposal& proposal, const MoveTask& move) {
  json["target_counts"] = move.target_counts;
  json["target"] = proposal.target;
  if (move.drive) {
    json["drive"] = *move.drive;
  }
}

}  // namespace

nlohmann::json to_json(const Proposal& proposal) {
  const Task& task = *proposal.task;
  nlohmann::json json{{"id", proposal.id},
                      {"kind", kind_name(task.kind())},
                      {"slot", nullptr},
                      {"axis", nullptr},
                      {"axes", proposal.axes},
                      {"step", nullptr},
                      {"author", task.author},
                      {"source", source_name(task.source)},
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
  if (task.mode > RobotMode::home) {
    json["mode"] = mode_name(task.mode);
  }
  if (const auto* move = proposal.work<MoveTask>()) {
    add(json, proposal, *move);
  } else if (const auto* path = proposal.work<PathTask>()) {
    add(json, proposal, *path);
  } else if (const auto* sweep = proposal.work<SweepTask>()) {
    add(json, proposal, *sweep);
  } else if (const auto* insertion = proposal.work<BiopsyTask>()) {
    add(json, proposal, *insertion);
  }
  if (!proposal.step.empty()) {
    json["step"] = proposal.step;
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
