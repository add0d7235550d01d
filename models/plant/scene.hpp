/**
 * @file
 * What a needle robot works on: needle, tissue with membranes, target and scanner, as the plant file says.
 *
 * Depths are along the needle from the skin; the guide frame has its origin where the tip touches the skin, z
 * ahead, and at rotation 0 the bevel bends the path towards -y.
 */
#ifndef INTERLOCK_PLANT_SCENE_HPP
#define INTERLOCK_PLANT_SCENE_HPP

#include <array>
#include <cstddef>
#include <vector>

namespace interlock::plant {

/** One axis of the needle. */
struct NeedleAxis {
  std::size_t slot = 0;
  double counts_per_unit = 1.0; /**< mm or rad, positive ahead */
};

/** The analog input at which a force is read. */
struct ForceInput {
  std::size_t slot = 0;
  std::size_t input = 0; /**< 0 is ADC 1 */
  double counts_per_newton = 1.0;
};

/** A layer of tissue; the last one goes on for ever. */
struct TissueLayer {
  double thickness_mm = 25.0;
  double cutting_n = 0.6;
  double stiffness_n_per_mm = 0.3;
  double friction_n_per_mm = 0.02;
};

struct TissueMembrane {
  double depth_mm = 0.0;
  double stiffness_n_per_mm = 0.8;
  double puncture_n = 2.0;
};

struct SceneParameters {
  NeedleAxis insertion;
  NeedleAxis rotation;
  ForceInput hand;       /**< pressed by the surgeon */
  ForceInput tip;        /**< pressed by the tissue */
  double entry_mm = 0.0; /**< position of the insertion at which the tip touches the skin */
  double curvature_per_mm = 0.0041;
  double wander_rad = 0.0;        /**< by which tissue turns the way ahead, after a millimetre */
  double bevel_rad = 0.0;         /**< angle of the bevel when the rotation says 0 */
  double torsion_play_rad = 0.0;  /**< by which hub and tip may differ before the tip turns, either way */
  double windup_rad_per_mm = 0.0; /**< and as much more for each mm in tissue */
  double texture_n = 0.05;
  std::vector<TissueLayer> layers;       /**< from the skin, at least one */
  std::vector<TissueMembrane> membranes; /**< by depth */
  std::array<double, 3> target_mm{0.0, 0.0, 50.0};
  double dragged_share = 0.0; /**< of the depth, by which the needle pushes the target ahead */
  double image_period_s = 2.0;
  double image_age_s = 1.0;
  double image_deviation_mm = 0.5;
  double image_tip_bias_mm = 0.0;  /**< by which the artefact of the needle lies beside the tip, along x */
  double image_breathing_mm = 0.0; /**< amplitude by which a breath moves all that is seen, along y */
  double image_breath_s = 4.3;     /**< a breath lasts */
};

}  // namespace interlock::plant

#endif
