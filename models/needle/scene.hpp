/**
 * @file
 * Needle, tissue and scanner around the plant: the axes move the needle, and what it meets presses on the
 * force sensors.
 */
#ifndef INTERLOCK_NEEDLE_SCENE_HPP
#define INTERLOCK_NEEDLE_SCENE_HPP

#include "needle/imager.hpp"
#include "needle/needle.hpp"
#include "needle/tissue.hpp"
#include "plant/scene.hpp"
#include "plant/surroundings.hpp"

namespace interlock::needle {

class Scene final : public plant::Surroundings {
 public:
  /** @param seed of the whole plant; needle, tissue and scanner draw from streams of their own */
  Scene(const plant::SceneParameters& parameters, std::uint64_t seed);

  void advance(const plant::AxisPositions& counts, plant::Microseconds elapsed) noexcept override;
  std::span<const plant::SensorLoad> loads() const noexcept override { return loads_; }
  void press_hand(double force_n) noexcept override;
  void shift_target(const std::array<double, 3>& by_mm) noexcept override;
  const std::optional<plant::TipImage>& newest_image() const noexcept override { return image_; }
  plant::NeedleTruth truth() const noexcept override;

 private:
  void press(plant::SensorLoad& load, const plant::ForceInput& at, double force_n) const;

  plant::SceneParameters parameters_;
  Needle needle_;
  Tissue tissue_;
  Imager imager_;
  Eigen::Vector3d target_mm_;
  std::optional<plant::TipImage> image_;
  std::array<plant::SensorLoad, 2> loads_{};
  std::vector<double> punctures_mm_;
  double time_s_ = 0.0;
  double depth_mm_ = 0.0;
  double deepest_mm_ = 0.0;
  std::optional<double> rotation_rad_; /**< when last seen */
  double hand_n_ = 0.0;
  double needle_n_ = 0.0;
};

}  // namespace interlock::needle

#endif
