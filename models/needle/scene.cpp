#include "needle/scene.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::needle {
namespace {

constexpr std::uint64_t needle_stream = 0x600;
constexpr std::uint64_t tissue_stream = 0x601;
constexpr std::uint64_t image_stream = 0x602;

NeedleParameters needle_of(const plant::SceneParameters& scene) {
  NeedleParameters needle;
  needle.curvature_per_mm = scene.curvature_per_mm;
  needle.wander_rad = scene.wander_rad;
  needle.bevel_rad = scene.bevel_rad;
  needle.torsion_play_rad = scene.torsion_play_rad;
  needle.windup_rad_per_mm = scene.windup_rad_per_mm;
  return needle;
}

TissueParameters tissue_of(const plant::SceneParameters& scene) {
  TissueParameters tissue;
  for (const plant::TissueLayer& layer : scene.layers) {
    tissue.layers.push_back(
        {layer.thickness_mm, layer.cutting_n, layer.stiffness_n_per_mm, layer.friction_n_per_mm});
  }
  for (const plant::TissueMembrane& membrane : scene.membranes) {
    tissue.membranes.push_back({.depth_mm = membrane.depth_mm,
                                .stiffness_n_per_mm = membrane.stiffness_n_per_mm,
                                .puncture_n = membrane.puncture_n});
  }
  tissue.texture_n = scene.texture_n;
  return tissue;
}

std::array<double, 3> listed(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Eigen::Vector3d vector_of(const std::array<double, 3>& list) { return {list[0], list[1], list[2]}; }

}  // namespace

Scene::Scene(const plant::SceneParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      needle_(needle_of(parameters), Noise(seed, needle_stream)),
      tissue_(tissue_of(parameters), Noise(seed, tissue_stream)),
      imager_({parameters.image_period_s, parameters.image_age_s, parameters.image_deviation_mm,
               parameters.image_tip_bias_mm, parameters.image_breathing_mm, parameters.image_breath_s},
              Noise(seed, image_stream)),
      target_mm_(vector_of(parameters.target_mm)) {
  punctures_mm_.reserve(parameters.membranes.size());
}

void Scene::advance(const plant::AxisPositions& counts, plant::Microseconds elapsed) noexcept {
  const double period_s = static_cast<double>(elapsed.count()) * 1e-6;
  time_s_ += period_s;
  const plant::NeedleAxis& insertion = parameters_.insertion;
  const plant::NeedleAxis& rotation = parameters_.rotation;
  depth_mm_ = counts[insertion.slot] / insertion.counts_per_unit - parameters_.entry_mm;
  const double rotation_rad = counts[rotation.slot] / rotation.counts_per_unit;
  const double way_mm = std::max(0.0, depth_mm_ - deepest_mm_);
  // The bevel stands at the axis' position from the start on.
  needle_.move(way_mm, rotation_rad - rotation_rad_.value_or(0.0));
  rotation_rad_ = rotation_rad;
  deepest_mm_ += way_mm;
  target_mm_.z() += parameters_.dragged_share * way_mm;
  needle_n_ = deepest_mm_ > 0.0 ? tissue_.press(std::max(0.0, depth_mm_), period_s) : 0.0;
  if (depth_mm_ <= 0.0) {
    needle_n_ = 0.0;
  }
  for (std::size_t torn = punctures_mm_.size(); torn < tissue_.punctures().size(); ++torn) {
    punctures_mm_.push_back(tissue_.punctures()[torn].depth_mm);
  }
  if (const auto image = imager_.at(time_s_, needle_.tip_mm(), target_mm_)) {
    image_ = plant::TipImage{image->time_s, listed(image->tip_mm), listed(image->target_mm)};
  }
  press(loads_[0], parameters_.hand, hand_n_);
  press(loads_[1], parameters_.tip, needle_n_);
}

void Scene::press(plant::SensorLoad& load, const plant::ForceInput& at, double force_n) const {
  constexpr double most = 65535.0;
  const double counts = std::clamp(force_n * at.counts_per_newton, -most, most);
  load = {at.slot, at.input, static_cast<std::int32_t>(std::lround(counts))};
}

void Scene::press_hand(double force_n) noexcept { hand_n_ = force_n; }

void Scene::shift_target(const std::array<double, 3>& by_mm) noexcept { target_mm_ += vector_of(by_mm); }

plant::NeedleTruth Scene::truth() const noexcept {
  return {depth_mm_, listed(needle_.tip_mm()), listed(target_mm_), hand_n_, needle_n_, punctures_mm_};
}

}  // namespace interlock::needle
