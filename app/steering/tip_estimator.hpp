/**
 * @file
 * Where the needle's tip is now, from images of where it was.
 *
 * An extended Kalman filter. Its state is the tip's pose and the largest curvature of this needle in this
 * tissue; between images the tip model moves it by what the axes did. An image shows the tip's position at
 * the time of its exposure and arrives later. So the filter keeps its state at the newest image's exposure,
 * the anchor, and every motion since: an image moves the anchor to its own exposure, corrects it there, and
 * the motions since are played again. The result is that of a filter which had each image in time.
 *
 *     error = (rho, phi, kappa):  true pose = pose exp(rho, phi) in the tip frame, true curvature = curvature
 * + kappa prediction: error <- [Ad(exp(-xi)), B; 0, 1] error,  xi the twist of the motion, B = Ad(exp(-xi /
 * 2)) dxi/dkappa image:      R^T (image - position) = rho + noise, the same in all directions
 *
 * Tissue that bends the needle by itself enters as a drift of direction and curvature with the depth. Frames:
 * guide, as the needle enters the tissue, z ahead; tip, as in steering_target.hpp.
 */
#pragma once

#include <cstddef>
#include <vector>

#include "steering/innovation_watch.hpp"
#include "steering/tip_model.hpp"

namespace interlock {

/** What is believed before the first image, and how far it is to be trusted; each one standard deviation. */
struct TipBelief {
  double curvature_per_mm = 0.0041;     /**< largest of the needle: published data of an 18G needle */
  double curvature_sd_per_mm = 0.0005;  /**< an even spread of 20 % has 12 % */
  double start_sd_mm = 0.5;             /**< of the entry, each coordinate */
  double direction_sd_rad = 0.0175;     /**< of the way ahead at the entry */
  double bevel_sd_rad = 0.05;           /**< of the bevel's angle at rotation 0 */
  double direction_drift_rad = 1e-3;    /**< a millimetre of depth, growing with its root */
  double curvature_drift_per_mm = 2e-5; /**< a millimetre of depth, growing with its root */
  double image_sd_mm = 0.5;             /**< of an image of the tip, each coordinate */
  double widest_surprise_sd = 6.0;      /**< an image further from where it is expected is refused */
  double widest_ahead_sd = 3.0; /**< so is one further along the way: the encoder knows how deep the tip is */
};

/** Where the tip is believed to be. */
struct TipEstimate {
  Pose guide_from_tip = Pose::Identity();
  double curvature_per_mm = 0.0;    /**< largest of this needle in this tissue */
  double curvature_sd_per_mm = 0.0; /**< as of the anchor */
  double position_sd_mm = 0.0;      /**< root mean square of the three, as of the anchor */
};

/** Follows the tip by the axes, corrected by late images. */
class TipEstimator {
 public:
  /** Motions that are kept; beyond that the anchor moves on, and images of before it come too late. */
  static constexpr std::size_t kept_motions = 8192;

  /** The tip is at the origin of the guide frame at `time_s`. Memory is taken here alone. */
  static KinematicsResult<TipEstimator> create(const TipBelief& belief, double time_s);

  /** The needle moved so far until `time_s`, which is later than all before. */
  KinematicsResult<void> move(double time_s, const NeedleMotion& motion) noexcept;

  /**
   * An image, exposed at `time_s`, shows the tip in the guide frame. OUT_OF_RANGE names an exposure before
   * the anchor or after the last motion, and a tip too far from where it can be; the estimate stays as it is
   * then.
   */
  KinematicsResult<void> see(double time_s, const Eigen::Vector3d& tip_mm) noexcept;

  [[nodiscard]] const TipEstimate& now() const noexcept { return now_; }

  /** Whether the images, refused ones too, contradict needle, encoders and what is believed of them. */
  [[nodiscard]] bool images_disagree() const noexcept { return watch_.disagrees(); }

 private:
  using Error = Eigen::Matrix<double, 7, 1>;
  using Covariance = Eigen::Matrix<double, 7, 7>;

  struct TimedMotion {
    double end_s = 0.0;
    NeedleMotion motion;
  };

  TipEstimator(const TipBelief& belief, double time_s);

  [[nodiscard]] const TimedMotion& oldest() const noexcept { return motions_[first_]; }
  void drop_oldest() noexcept;
  void keep(const TimedMotion& motion) noexcept;
  void predict(const NeedleMotion& motion) noexcept;
  void move_anchor(double time_s) noexcept;
  void correct(const Error& error) noexcept;
  void play_again() noexcept;

  TipBelief belief_;
  std::vector<TimedMotion> motions_; /**< ring of those after the anchor */
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  double anchor_s_;
  double now_s_;
  Pose anchor_ = Pose::Identity();
  double curvature_per_mm_;
  Covariance covariance_ = Covariance::Zero();
  TipEstimate now_;
  InnovationWatch watch_;
};

}  // namespace interlock
