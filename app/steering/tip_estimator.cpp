#include "steering/tip_estimator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinematics/domain.hpp"
#include "steering/curv_law.hpp"

namespace interlock {
namespace {

using Adjoint = Eigen::Matrix<double, 6, 6>;

/** A needle always bends a little; also keeps the curvature positive when an image says otherwise. */
constexpr double smallest_curvature_per_mm = 1e-5;
constexpr double latest_s = 1e6;

Pose step_of(const NeedleMotion& motion, double curvature_per_mm) noexcept {
  return exponential(Eigen::Vector3d(0.0, 0.0, motion.insertion_mm), tip_rotation(motion, curvature_per_mm));
}

/** Carries (translation, rotation) through a pose. */
Adjoint adjoint(const Pose& pose) noexcept {
  const Eigen::Matrix3d turn = pose.linear();
  Adjoint result = Adjoint::Zero();
  result.topLeftCorner<3, 3>() = turn;
  result.bottomRightCorner<3, 3>() = turn;
  for (int column = 0; column < 3; ++column) {
    result.block<3, 1>(0, 3 + column) = pose.translation().cross(turn.col(column));
  }
  return result;
}

NeedleMotion part_of(const NeedleMotion& motion, double part) noexcept {
  return {part * motion.insertion_mm, part * motion.rotation_rad};
}

bool rests(const NeedleMotion& motion) noexcept {
  return motion.insertion_mm == 0.0 && motion.rotation_rad == 0.0;
}

KinematicsResult<void> check_belief(const TipBelief& belief) noexcept {
  return check_range("curvature_per_mm", belief.curvature_per_mm, smallest_curvature_per_mm,
                     curvature_limit_per_mm)
      .and_then([&] {
        return check_range("curvature_sd_per_mm", belief.curvature_sd_per_mm, 0.0, curvature_limit_per_mm);
      })
      .and_then([&] { return check_range("start_sd_mm", belief.start_sd_mm, 0.0, 100.0); })
      .and_then([&] { return check_range("direction_sd_rad", belief.direction_sd_rad, 0.0, 1.0); })
      .and_then([&] { return check_range("bevel_sd_rad", belief.bevel_sd_rad, 0.0, 4.0); })
      .and_then([&] { return check_range("direction_drift_rad", belief.direction_drift_rad, 0.0, 0.1); })
      .and_then([&] {
        return check_range("curvature_drift_per_mm", belief.curvature_drift_per_mm, 0.0,
                           curvature_limit_per_mm);
      })
      .and_then([&] { return check_range("image_sd_mm", belief.image_sd_mm, 1e-3, 100.0); })
      .and_then([&] { return check_range("widest_surprise_sd", belief.widest_surprise_sd, 1.0, 1000.0); })
      .and_then([&] { return check_range("widest_ahead_sd", belief.widest_ahead_sd, 1.0, 1000.0); });
}

}  // namespace

KinematicsResult<TipEstimator> TipEstimator::create(const TipBelief& belief, double time_s) {
  return check_belief(belief)
      .and_then([&] { return check_range("time_s", time_s, -latest_s, latest_s); })
      .map([&] { return TipEstimator(belief, time_s); });
}

TipEstimator::TipEstimator(const TipBelief& belief, double time_s)
    : belief_(belief),
      motions_(kept_motions),
      anchor_s_(time_s),
      now_s_(time_s),
      curvature_per_mm_(belief.curvature_per_mm) {
  Error deviation;
  deviation << Eigen::Vector3d::Constant(belief.start_sd_mm), belief.direction_sd_rad,
      belief.direction_sd_rad, belief.bevel_sd_rad, belief.curvature_sd_per_mm;
  covariance_ = deviation.cwiseAbs2().asDiagonal();
  play_again();
}

KinematicsResult<void> TipEstimator::move(double time_s, const NeedleMotion& motion) noexcept {
  return check_range("time_s", time_s, std::nextafter(now_s_, latest_s), latest_s)
      .and_then([&] { return check_motion(motion, curvature_per_mm_); })
      .map([&] {
        keep({time_s, motion});
        now_s_ = time_s;
        now_.guide_from_tip = now_.guide_from_tip * step_of(motion, curvature_per_mm_);
      });
}

KinematicsResult<void> TipEstimator::see(double time_s, const Eigen::Vector3d& tip_mm) noexcept {
  return check_range("image_time_s", time_s, anchor_s_, now_s_)
      .and_then([&] { return check_point({"image_x_mm", "image_y_mm", "image_z_mm"}, tip_mm); })
      .and_then([&]() -> KinematicsResult<void> {
        move_anchor(time_s);
        const Eigen::Vector3d innovation = anchor_.linear().transpose() * (tip_mm - anchor_.translation());
        const double image_variance = belief_.image_sd_mm * belief_.image_sd_mm;
        const Eigen::Matrix3d inverse =
            (covariance_.topLeftCorner<3, 3>() + image_variance * Eigen::Matrix3d::Identity()).inverse();
        const double squared = std::max(0.0, innovation.dot(inverse * innovation));
        const double surprise = std::sqrt(squared);
        watch_.add(squared);
        const double ahead = innovation.z() / std::sqrt(covariance_(2, 2) + image_variance);
        const auto checked =
            check_range("image_surprise_sd", surprise, 0.0, belief_.widest_surprise_sd).and_then([&] {
              return check_range("image_ahead_sd", ahead, -belief_.widest_ahead_sd, belief_.widest_ahead_sd);
            });
        if (!checked) {
          return checked;
        }
        const Eigen::Matrix<double, 7, 3> gain = covariance_.leftCols<3>() * inverse;
        Covariance rest = Covariance::Identity();
        rest.leftCols<3>() -= gain;
        covariance_ =
            (rest * covariance_ * rest.transpose() + image_variance * gain * gain.transpose()).eval();
        correct(gain * innovation);
        play_again();
        return {};
      });
}

void TipEstimator::drop_oldest() noexcept {
  first_ = (first_ + 1) % motions_.size();
  --count_;
}

void TipEstimator::keep(const TimedMotion& motion) noexcept {
  if (count_ > 0) {
    TimedMotion& last = motions_[(first_ + count_ - 1) % motions_.size()];
    if (rests(last.motion) && rests(motion.motion)) {
      last.end_s = motion.end_s;
      return;
    }
  }
  if (count_ == motions_.size()) {
    move_anchor(oldest().end_s);
  }
  motions_[(first_ + count_) % motions_.size()] = motion;
  ++count_;
}

void TipEstimator::predict(const NeedleMotion& motion) noexcept {
  if (rests(motion)) {
    return;
  }
  const Pose step = step_of(motion, curvature_per_mm_);
  const Pose half = step_of(part_of(motion, 0.5), curvature_per_mm_);
  Covariance transition = Covariance::Identity();
  transition.topLeftCorner<6, 6>() = adjoint(step.inverse());
  transition.topRightCorner<6, 1>() = motion.insertion_mm * adjoint(half.inverse()).col(3);
  covariance_ = (transition * covariance_ * transition.transpose()).eval();
  const double direction_variance = belief_.direction_drift_rad * belief_.direction_drift_rad;
  covariance_(3, 3) += direction_variance * motion.insertion_mm;
  covariance_(4, 4) += direction_variance * motion.insertion_mm;
  covariance_(6, 6) += belief_.curvature_drift_per_mm * belief_.curvature_drift_per_mm * motion.insertion_mm;
  anchor_ = anchor_ * step;
}

void TipEstimator::move_anchor(double time_s) noexcept {
  while (count_ > 0 && oldest().end_s <= time_s) {
    predict(oldest().motion);
    anchor_s_ = oldest().end_s;
    drop_oldest();
  }
  if (count_ > 0 && time_s > anchor_s_) {
    TimedMotion& under_way = motions_[first_];
    const double part = (time_s - anchor_s_) / (under_way.end_s - anchor_s_);
    predict(part_of(under_way.motion, part));
    under_way.motion = part_of(under_way.motion, 1.0 - part);
  }
  anchor_s_ = time_s;
}

void TipEstimator::correct(const Error& error) noexcept {
  anchor_ = anchor_ * exponential(error.head<3>(), error.segment<3>(3));
  // Rounding does not add up over a long insertion.
  anchor_.linear() = Eigen::Quaterniond(anchor_.linear()).normalized().toRotationMatrix();
  curvature_per_mm_ =
      std::clamp(curvature_per_mm_ + error(6), smallest_curvature_per_mm, curvature_limit_per_mm);
}

void TipEstimator::play_again() noexcept {
  now_ = {anchor_, curvature_per_mm_, std::sqrt(std::max(0.0, covariance_(6, 6))),
          std::sqrt(std::max(0.0, covariance_.topLeftCorner<3, 3>().trace() / 3.0))};
  for (std::size_t kept = 0; kept < count_; ++kept) {
    now_.guide_from_tip =
        now_.guide_from_tip * step_of(motions_[(first_ + kept) % motions_.size()].motion, curvature_per_mm_);
  }
}

}  // namespace interlock
