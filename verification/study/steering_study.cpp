/// Runs insertions on a range of seeds and prints one JSON object: tip errors by what steers, and membranes.
///
/// Usage: steering_study FIRST_SEED LAST_SEED

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "membrane_experiment.hpp"
#include "steering_experiment.hpp"

namespace {

using interlock::experiment::insert;
using interlock::experiment::MembraneOutcome;
using interlock::experiment::MembraneWorld;
using interlock::experiment::pass_membranes;
using interlock::experiment::Steering;
using interlock::experiment::SteeringOutcome;
using interlock::experiment::SteeringWorld;
using nlohmann::json;

struct Seeds {
  std::uint64_t first = 0;
  std::uint64_t last = 0;

  double count() const { return static_cast<double>(last - first + 1); }
};

/// Smallest value with at least that share of all at or below it.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) {
    squares += value * value;
  }
  return std::sqrt(squares / static_cast<double>(values.size()));
}

json spread(const std::vector<double>& values) {
  return {{"rms", rms(values)},
          {"median", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"worst", quantile(values, 1.0)}};
}

json tip_errors(const SteeringWorld& world, Steering steering, Seeds seeds) {
  std::vector<double> errors;
  std::vector<double> beside;
  std::vector<double> estimates;
  std::vector<double> curvatures;
  std::vector<double> durations;
  std::uint32_t arrived = 0;
  std::uint32_t refused = 0;
  std::uint32_t fused = 0;
  std::uint32_t out_of_reach = 0;
  std::uint32_t flagged = 0;
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const SteeringOutcome outcome = insert(world, steering, seed);
    errors.push_back(outcome.error_mm);
    beside.push_back(outcome.beside_mm);
    estimates.push_back(outcome.estimate_error_mm);
    curvatures.push_back(outcome.estimated_per_mm / outcome.curvature_per_mm - 1.0);
    durations.push_back(outcome.duration_s);
    arrived += outcome.arrived ? 1 : 0;
    refused += outcome.images_refused;
    fused += outcome.images_fused;
    out_of_reach += outcome.out_of_reach > 0 ? 1 : 0;
    flagged += outcome.flagged ? 1 : 0;
  }
  return {{"insertions", errors.size()},
          {"arrived", arrived},
          {"tip_error_mm", spread(errors)},
          {"tip_error_beside_mm", spread(beside)},
          {"estimate_error_mm", spread(estimates)},
          {"curvature_error", spread(curvatures)},
          {"duration_s", spread(durations)},
          {"images_fused", fused},
          {"images_refused", refused},
          {"flagged", flagged},
          {"insertions_out_of_reach_for_a_while", out_of_reach}};
}

json steering(Seeds seeds) {
  const std::map<std::string, Steering> by{{"without rotation", Steering::still},
                                           {"even rotation", Steering::spinning},
                                           {"compensation, published alpha", Steering::published},
                                           {"compensation", Steering::averaged}};
  json result;
  for (const auto& [name, how] : by) {
    result["as stated"][name] = tip_errors({}, how, seeds);
  }
  SteeringWorld stiff;
  stiff.curvature_per_mm = 0.0022;
  SteeringWorld blurred;
  blurred.imager.deviation_mm = 1.0;
  SteeringWorld unshifted;
  unshifted.least_shift_mm = 0.0;
  unshifted.most_shift_mm = 0.0;
  for (const auto& [name, world] : std::map<std::string, SteeringWorld>{
           {"stiff needle, 0.0022 per mm", stiff}, {"images of 1 mm", blurred}, {"no shift", unshifted}}) {
    result[name]["even rotation"] = tip_errors(world, Steering::spinning, seeds);
    result[name]["compensation"] = tip_errors(world, Steering::averaged, seeds);
  }
  return result;
}

/// What nobody tells the controller, in parts and more of what may be met.
json disturbed(Seeds seeds) {
  json result = json::array();
  for (const double part : {0.25, 0.5, 1.0, 2.0}) {
    std::map<std::string, std::pair<SteeringWorld, double>> worlds;
    const auto world = [&](const char* name, double size) -> SteeringWorld& {
      worlds[name].second = part * size;
      return worlds[name].first;
    };
    world("breathing, mm", 3.0).imager.breathing_mm = part * 3.0;
    world("tip image beside the tip, mm", 2.0).imager.tip_bias_mm = part * 2.0;
    world("target pushed ahead, % of the depth", 6.0).dragged_share = part * 0.06;
    world("bevel off, degrees", 20.0).bevel_rad = part * std::numbers::pi / 9;
    world("torsion, play in degrees", 20.0).torsion_play_rad = part * std::numbers::pi / 9;
    for (const auto& [name, made] : worlds) {
      json row = tip_errors(made.first, Steering::averaged, seeds);
      row["disturbance"] = name;
      row["size"] = made.second;
      result.push_back(std::move(row));
    }
  }
  return result;
}

json membranes(const MembraneWorld& world, Seeds seeds) {
  std::vector<double> latencies;
  std::uint32_t punctures = 0;
  std::uint32_t hits = 0;
  std::uint32_t false_alarms = 0;
  std::uint32_t rough = 0;
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const MembraneOutcome outcome = pass_membranes(world, seed);
    punctures += outcome.punctures;
    hits += outcome.hits;
    false_alarms += outcome.false_alarms;
    rough += outcome.rough ? 1 : 0;
    latencies.insert(latencies.end(), outcome.latencies_s.begin(), outcome.latencies_s.end());
  }
  json result{{"insertions", seeds.count()},
              {"punctures", punctures},
              {"hits", hits},
              {"false_alarms", false_alarms},
              {"false_alarms_per_insertion", false_alarms / seeds.count()},
              {"said_rough", rough}};
  if (punctures > 0) {
    result["hit_share"] = static_cast<double>(hits) / punctures;
  }
  if (!latencies.empty()) {
    result["cue_latency_s"] = spread(latencies);
  }
  return result;
}

json detection(Seeds seeds) {
  json result;
  for (const std::uint32_t factor : {1u, 2u, 3u, 4u, 5u}) {
    MembraneWorld world;
    world.force_noise_counts *= factor;
    world.texture_n *= factor;
    result[factor == 1 ? "as stated" : "noise times " + std::to_string(factor)] = membranes(world, seeds);
  }
  result["no membranes"] = membranes({.absent = 1.0}, seeds);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: steering_study FIRST_SEED LAST_SEED\n";
    return 2;
  }
  const Seeds seeds{std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10)};
  if (seeds.first == 0 || seeds.last < seeds.first || seeds.last > 1'000'000) {
    std::cerr << "seeds go from 1 to 1000000, the first before the last\n";
    return 2;
  }
  const json result{{"seeds", {seeds.first, seeds.last}},
                    {"steering", steering(seeds)},
                    {"disturbed", disturbed(seeds)},
                    {"membranes", detection(seeds)}};
  std::cout << result.dump(1) << "\n";
  return 0;
}
