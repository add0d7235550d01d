#include "needle/needle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace interlock::needle {
namespace {

double counted(double position, double counts_per_unit) {
  return std::floor(position * counts_per_unit) / counts_per_unit;
}

}  // namespace

Needle::Needle(const NeedleParameters& parameters, const Noise& noise)
    : parameters_(parameters),
      noise_(noise),
      tip_mm_(parameters.entry_mm.x(), parameters.entry_mm.y(), 0.0),
      ahead_(Eigen::Vector3d(parameters.tilt_rad.x(), parameters.tilt_rad.y(), 1.0).normalized()),
      bend_(-Eigen::Vector3d::UnitY()) {
  point(ahead_);
  turn(parameters.bevel_rad);
}

void Needle::advance(double wanted_insertion_mm_s, double wanted_rotation_rad_s, double period_s) {
  const double share = period_s / (parameters_.lag_s + period_s);
  insertion_mm_s_ += share * (wanted_insertion_mm_s - insertion_mm_s_);
  rotation_rad_s_ += share * (wanted_rotation_rad_s - rotation_rad_s_);
  const double turned_rad = period_s * rotation_rad_s_;
  const double way_mm = period_s * std::max(0.0, insertion_mm_s_);
  move(way_mm, turned_rad);
}

void Needle::move(double way_mm, double turned_rad) {
  const double most_rad = parameters_.torsion_play_rad + parameters_.windup_rad_per_mm * insertion_mm_;
  const double wound_rad = std::clamp(wound_rad_ + turned_rad, -most_rad, most_rad);
  const double tip_rad = wound_rad_ + turned_rad - wound_rad;
  wound_rad_ = wound_rad;
  turn(tip_rad / 2.0);
  go(way_mm);
  wander(way_mm);
  turn(tip_rad / 2.0);
  rotation_rad_ += turned_rad;
  insertion_mm_ += way_mm;
}

double Needle::seen_insertion_mm() const {
  return counted(insertion_mm_, parameters_.insertion_counts_per_mm);
}

double Needle::seen_rotation_rad() const {
  return counted(rotation_rad_, parameters_.rotation_counts_per_rad);
}

void Needle::turn(double angle_rad) {
  bend_ = bend_ * std::cos(angle_rad) + ahead_.cross(bend_) * std::sin(angle_rad);
}

void Needle::go(double way_mm) {
  const double angle_rad = parameters_.curvature_per_mm * way_mm;
  // Across the circle by its half angle: exact where the angle is too small for 1 - cos.
  const double half_sine = std::sin(angle_rad / 2.0);
  const double chord_mm = angle_rad > 0.0 ? 2.0 * half_sine / parameters_.curvature_per_mm : way_mm;
  tip_mm_ += chord_mm * (std::cos(angle_rad / 2.0) * ahead_ + half_sine * bend_);
  point(std::cos(angle_rad) * ahead_ + std::sin(angle_rad) * bend_);
}

void Needle::wander(double way_mm) {
  const double deviation_rad = parameters_.wander_rad * std::sqrt(way_mm);
  const double along_bend_rad = noise_.normal(deviation_rad);
  const double across_rad = noise_.normal(deviation_rad);
  point(ahead_ + along_bend_rad * bend_ + across_rad * ahead_.cross(bend_));
}

void Needle::point(const Eigen::Vector3d& ahead) {
  ahead_ = ahead.normalized();
  bend_ = (bend_ - bend_.dot(ahead_) * ahead_).normalized();
}

}  // namespace interlock::needle
