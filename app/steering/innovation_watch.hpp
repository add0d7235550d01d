/**
 * @file
 * Whether measurements still agree with what a filter believes.
 *
 * The squared innovation of a point, normalised by its covariance, has a chi-square distribution with three
 * degrees of freedom as long as the model holds; the sum over a window has three for each (Bar-Shalom, Li,
 * Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 5.4). A sum beyond the quantile
 * 0.9999 says that model and measurements contradict each other. A bias that was there from the beginning the
 * filter takes for the truth: no watch over innovations can see it.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace interlock {

class InnovationWatch {
 public:
  static constexpr std::size_t window = 8;

  /** The normalised squared innovation of a point, that of a refused one too. */
  void add(double squared) noexcept {
    last_[next_] = std::min(squared, most_squared);
    next_ = (next_ + 1) % window;
    count_ = std::min(count_ + 1, window);
  }

  /** Whether they contradict what is believed; it takes two to say so. */
  [[nodiscard]] bool disagrees() const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < count_; ++n) {
      sum += last_[n];
    }
    return count_ > 1 && sum > limits[count_ - 1];
  }

 private:
  /** Quantiles 0.9999 of 3, 6, ... 24 degrees of freedom. */
  static constexpr std::array limits{21.1, 27.9, 33.7, 39.1, 44.3, 49.2, 54.0, 58.6};
  /** One wild point among good ones says nothing; two do. */
  static constexpr double most_squared = 20.0;

  std::array<double, window> last_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace interlock
