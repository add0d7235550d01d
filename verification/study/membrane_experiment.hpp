/**
 * @file
 * One insertion through membranes, with the detector listening and its cue shaking the needle.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "steering/membrane_detector.hpp"

namespace interlock::experiment {

/** The world, as far as a study sets it; what is drawn for each seed is drawn evenly. */
struct MembraneWorld {
  std::uint32_t force_noise_counts = 3; /**< of the sensors, either way: models/plant/prostate.toml */
  double texture_n = 0.05;              /**< of the tissue, standard deviation */
  double least_puncture_n = 1.0;
  double most_puncture_n = 2.5;
  double depth_error_mm = 2.5; /**< of each membrane from where it is expected, either way */
  double absent = 0.1;         /**< chance that a membrane which is expected is not there */
};

struct MembraneOutcome {
  std::uint32_t punctures = 0;
  std::uint32_t hits = 0;          /**< cue within `latest_cue_s` after its puncture */
  std::uint32_t false_alarms = 0;  /**< any other cue */
  bool rough = false;              /**< the detector said of the tissue at some time */
  std::vector<double> latencies_s; /**< of the hits */
};

inline constexpr double latest_cue_s = 0.15;

MembraneOutcome pass_membranes(const MembraneWorld& world, std::uint64_t seed,
                               const MembraneParameters& parameters = {});

}  // namespace interlock::experiment
