/** @file Images are late, seldom and blurred as they say. */
#include "needle/imager.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace interlock::needle::test {
namespace {

/** The tip at a time, so that an image tells when it was exposed. */
Eigen::Vector3d tip_at(double time_s) { return {0.0, 0.0, 4.0 * time_s}; }

struct Arrival {
  double time_s;
  Image image;
};

std::vector<Arrival> arrivals(const ImagerParameters& parameters, double until_s) {
  Imager imager(parameters, Noise(1, 0));
  std::vector<Arrival> seen;
  for (int tick = 0; tick < static_cast<int>(until_s * 1000.0); ++tick) {
    const double time_s = tick * 0.001;
    if (const auto image = imager.at(time_s, tip_at(time_s), Eigen::Vector3d(1, 2, 3))) {
      seen.push_back({time_s, *image});
    }
  }
  return seen;
}

TEST(Imager, shows_every_two_seconds_what_was_one_second_ago) {
  const auto seen = arrivals({.deviation_mm = 0.0}, 10.0);
  ASSERT_EQ(seen.size(), 5u);
  for (std::size_t number = 0; number < seen.size(); ++number) {
    EXPECT_NEAR(seen[number].time_s, 2.0 * static_cast<double>(number) + 1.0, 0.0015);
    EXPECT_NEAR(seen[number].image.time_s, 2.0 * static_cast<double>(number), 0.0015);
    EXPECT_EQ(seen[number].image.tip_mm, tip_at(seen[number].image.time_s));
    EXPECT_EQ(seen[number].image.target_mm, Eigen::Vector3d(1, 2, 3));
  }
}

TEST(Imager, loses_no_image_that_is_older_than_the_next_exposure) {
  const auto seen = arrivals({.period_s = 0.5, .age_s = 3.0, .deviation_mm = 0.0}, 10.0);
  ASSERT_EQ(seen.size(), 14u);
  EXPECT_NEAR(seen.back().time_s - seen.back().image.time_s, 3.0, 0.0015);
}

TEST(Imager, blurs_tip_and_target_by_its_deviation) {
  const auto seen = arrivals({.period_s = 0.005, .age_s = 0.0, .deviation_mm = 0.5}, 20.0);
  double tip = 0.0;
  double target = 0.0;
  for (const auto& [time_s, image] : seen) {
    tip += (image.tip_mm - tip_at(image.time_s)).squaredNorm();
    target += (image.target_mm - Eigen::Vector3d(1, 2, 3)).squaredNorm();
  }
  const double count = 3.0 * static_cast<double>(seen.size());
  EXPECT_GT(seen.size(), 3000u);
  EXPECT_NEAR(std::sqrt(tip / count), 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(target / count), 0.5, 0.02);
}

}  // namespace
}  // namespace interlock::needle::test
