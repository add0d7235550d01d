/**
 * @file
 * The scanner: now and then an image of tip and target, blurred and late.
 */
#ifndef INTERLOCK_NEEDLE_IMAGER_HPP
#define INTERLOCK_NEEDLE_IMAGER_HPP

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "needle/noise.hpp"

namespace interlock::needle {

struct ImagerParameters {
  double period_s = 2.0;     /**< from exposure to exposure; the first at time 0 */
  double age_s = 1.0;        /**< from an exposure to the arrival of its image */
  double deviation_mm = 0.5; /**< of tip and target, each coordinate, normal */
  double tip_bias_mm = 0.0;  /**< by which the artefact of the needle lies beside the tip, along x */
  double breathing_mm = 0.0; /**< amplitude by which a breath moves all that is seen, along y */
  double breath_s = 4.3;     /**< a breath lasts; fourteen a minute, a person at rest */
};

/** What an image shows, in the guide frame. */
struct Image {
  double time_s = 0.0; /**< of its exposure */
  Eigen::Vector3d tip_mm;
  Eigen::Vector3d target_mm;
};

class Imager {
 public:
  Imager(const ImagerParameters& parameters, const Noise& noise) : parameters_(parameters), noise_(noise) {}

  /** Exposes when it is time, and hands out the image that arrives at `time_s`. */
  std::optional<Image> at(double time_s, const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& target_mm);

 private:
  ImagerParameters parameters_;
  Noise noise_;
  double next_s_ = 0.0;
  std::deque<Image> on_the_way_;
};

}  // namespace interlock::needle

#endif
