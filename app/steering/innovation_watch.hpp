/**
 * @file
 * Whether measurements still agree with what a filter believes.
 *
 * The squared innovation of a point, normalised by its covariance, has a chi-square distribution with three
 * degrees of freedom as long as the model holds; a sum of some has three for each (Bar-Shalom, Li,
 * Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 5.4). A sum beyond the quantile
 * 0.99999 says that model and measurements contradict each other. A bias that was there from the beginning
 * the filter takes for the truth: no watch over innovations can see it.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace interlock {

class InnovationWatch {
 public:
  static constexpr std::size_t window = 8;
  /** So many in a row have to agree with each other before the contradiction is over. */
  static constexpr std::size_t agreeing = 4;

  /** The normalised squared innovation of a point, that of a refused one too. True: it is one too many, and
   * the window begins anew. */
  bool add(double squared) noexcept {
    last_[next_] = std::min(squared, most_squared);
    next_ = (next_ + 1) % window;
    count_ = std::min(count_ + 1, window);
    if (exceeds()) {
      doubted_ = agreeing;
      count_ = next_ = 0;
      return true;
    }
    doubted_ -= doubted_ > 0 ? 1 : 0;
    return false;
  }

  /** Whether they contradict what is believed, or have not agreed again for long enough. */
  [[nodiscard]] bool disagrees() const noexcept { return doubted_ > 0; }

 private:
  /** Quantiles 0.99999 of 3, 6, ... 24 degrees of freedom. */
  static constexpr std::array limits{25.9, 33.1, 39.3, 45.1, 50.5, 55.7, 60.7, 65.6};
  /** One wild point among good ones says nothing; two do. */
  static constexpr double most_squared = 20.0;

  /** The newest two, three, ... or all of the window; one says nothing. */
  [[nodiscard]] bool exceeds() const noexcept {
    double sum = 0.0;
    bool too_much = false;
    for (std::size_t n = 0; n < count_; ++n) {
      sum += last_[(next_ + window - 1 - n) % window];
      too_much = too_much || (n > 0 && sum > limits[n]);
    }
    return too_much;
  }

  std::array<double, window> last_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::size_t doubted_ = 0; /**< points that have still to agree */
};

}  // namespace interlock
