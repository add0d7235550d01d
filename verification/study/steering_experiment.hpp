/**
 * @file
 * One insertion towards a target that shifts when the needle touches the tissue, with and without
 * compensation.
 */
#pragma once

#include <cstdint>

#include "needle/imager.hpp"
#include "steering/compensator.hpp"

namespace interlock::experiment {

/** What steers the needle. */
enum class Steering {
  still,     /**< nothing: the needle does not turn */
  spinning,  /**< nothing: it turns evenly and goes straight */
  published, /**< the compensator with the published fit of alpha */
  averaged,  /**< the compensator with the law's own average and the estimated curvature */
};

/** The world, as far as a study sets it. What is drawn for each seed is drawn evenly, unless said otherwise.
 */
struct SteeringWorld {
  double curvature_per_mm = 0.0041; /**< as the controller believes */
  double curvature_error = 0.2;     /**< the needle's own is up to this share off, either way */
  double depth_mm = 100.0;          /**< of the planned target, straight ahead */
  double least_shift_mm = 1.0;      /**< of the target at contact, in any direction */
  double most_shift_mm = 10.0;
  double entry_sd_mm = 0.3;             /**< normal, x and y */
  double tilt_sd_rad = 0.00873;         /**< normal, about x and y: half a degree */
  double bevel_rad = 0.0;               /**< by which the bevel is off for every needle */
  double bevel_sd_rad = 0.035;          /**< normal: two degrees */
  double torsion_play_rad = 0.0;        /**< between hub and tip, either way */
  double dragged_share = 0.0;           /**< of the depth, by which the needle pushes the target ahead */
  double wander_rad = 1e-3;             /**< of the way ahead after a millimetre of tissue, normal */
  std::uint32_t force_noise_counts = 3; /**< of the hand's sensor, either way */
  needle::ImagerParameters imager{};
};

struct SteeringOutcome {
  double error_mm = 0.0;  /**< from the tip to the target at the end */
  double beside_mm = 0.0; /**< the part of it across the planned way */
  double shift_mm = 0.0;
  double curvature_per_mm = 0.0; /**< of this needle */
  double estimated_per_mm = 0.0; /**< at the end; as believed, without compensation */
  double estimate_error_mm =
      0.0; /**< from the estimated to the true tip at the end; 0 without compensation */
  double duration_s = 0.0;
  std::uint32_t images_fused = 0;
  std::uint32_t images_refused = 0;
  std::uint32_t out_of_reach = 0; /**< periods with a target that the needle could not bend to */
  bool arrived = false;
  bool flagged = false;          /**< the images disagreed for a while */
  double flagged_error_mm = 0.0; /**< of the estimated tip when they first did, or at the end */
};

/** Same seed, same needle, hand, shift and noise, whatever steers. `parameters` tune the compensator. */
SteeringOutcome insert(const SteeringWorld& world, Steering steering, std::uint64_t seed,
                       const CompensatorParameters& parameters = {});

}  // namespace interlock::experiment
