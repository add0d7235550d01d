/**
 * @file
 * The one way in which an image of the needle's tip reaches the open biopsy, whoever sends it.
 */
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "service/context.hpp"

namespace interlock {

/** In which coordinates the points of an image are. */
enum class ImageFrame : std::uint8_t {
  guide,  /**< motion/biopsy_run.hpp */
  scanner /**< RAS */
};

/** What an image shows, mm. */
struct TipImage {
  ImageFrame frame = ImageFrame::guide;
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> target_mm;
  double age_ms = 0.0; /**< since its exposure */
};

/**
 * Hands it on. 409 NO_BIOPSY when none is open, 409 NO_FRAME for points of the scanner when the biopsy's
 * target was not given in the scanner, 503 OVERLOADED when the control thread takes none now. Whether the
 * compensation believes it, `images` and `images_refused` of the biopsy tell. On the network thread.
 */
tl::expected<void, Problem> show_tip_image(const Context& context, const TipImage& image);

}  // namespace interlock
