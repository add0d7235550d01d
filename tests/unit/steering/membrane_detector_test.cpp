/** @file What is a puncture and what is not, on forces made for the purpose. */
#include "steering/membrane_detector.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "../app/counted_allocations.hpp"
#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;
using Code = KinematicsError::Code;

constexpr double period_s = 0.001;
constexpr double speed_mm_s = 4.0;

MembraneDetector expecting(std::initializer_list<double> depths_mm, const MembraneParameters& rule = {}) {
  return MembraneDetector::create(rule, {depths_mm.begin(), depths_mm.size()}).value();
}

struct Cue {
  double depth_mm;
};

/** Goes in evenly from depth to depth; `force_n` is by depth. */
std::vector<Cue> go_in(MembraneDetector& detector, double from_mm, double to_mm,
                       const std::function<double(double)>& force_n) {
  std::vector<Cue> cues;
  for (double depth_mm = from_mm; depth_mm < to_mm; depth_mm += speed_mm_s * period_s) {
    if (detector.step({force_n(depth_mm), depth_mm, speed_mm_s})->found) {
      cues.push_back({depth_mm});
    }
  }
  return cues;
}

/** Rises by 1 N a millimetre to `peak_n` at `depth_mm`, then falls to what is below. */
std::function<double(double)> torn_at(double depth_mm, double peak_n, double rest_n = 0.3) {
  return [=](double at_mm) {
    const double leaning_n = std::max(rest_n, peak_n - (depth_mm - at_mm));
    return at_mm < depth_mm ? leaning_n : rest_n;
  };
}

TEST(MembraneDetector, cues_within_the_promised_time_and_records_the_depth_of_the_puncture) {
  MembraneDetector detector = expecting({20.0});
  const auto cues = go_in(detector, 0.0, 40.0, torn_at(21.0, 2.0));
  ASSERT_EQ(cues.size(), 1u);
  EXPECT_GT(cues[0].depth_mm, 21.0);
  EXPECT_LE(cues[0].depth_mm, 21.0 + 0.15 * speed_mm_s);
  EXPECT_EQ(detector.left(), 0u);
  EXPECT_THAT(detector.records(), ElementsAre(Optional(DoubleNear(21.0, 0.05))));
}

TEST(MembraneDetector, needs_a_drop_by_half_a_newton_and_by_its_share_of_the_peak) {
  for (const auto& [peak_n, rest_n, expected] :
       {std::tuple(0.45, -0.2, 0u), std::tuple(0.8, 0.1, 1u), std::tuple(0.8, 0.4, 0u),
        std::tuple(5.0, 4.0, 1u), std::tuple(5.0, 4.35, 0u)}) {
    MembraneDetector detector = expecting({20.0});
    EXPECT_EQ(go_in(detector, 0.0, 40.0, torn_at(20.0, peak_n, rest_n)).size(), expected)
        << peak_n << " to " << rest_n;
  }
}

TEST(MembraneDetector, takes_no_slow_decline_for_a_puncture) {
  MembraneDetector detector = expecting({20.0});
  // 2 N down over 6 mm: at 4 mm/s a fifth of a newton in 150 ms.
  const auto declining = [](double depth_mm) { return std::clamp(3.0 - (depth_mm - 17.0) / 3.0, 1.0, 3.0); };
  EXPECT_TRUE(go_in(detector, 0.0, 40.0, declining).empty());
  EXPECT_THAT(detector.records(), ElementsAre(Eq(std::nullopt)));
}

TEST(MembraneDetector, looks_only_near_the_next_membrane) {
  for (const double depth_mm : {10.0, 14.5, 25.5, 60.0}) {
    MembraneDetector detector = expecting({20.0});
    EXPECT_TRUE(go_in(detector, 0.0, 70.0, torn_at(depth_mm, 3.0)).empty()) << depth_mm;
  }
}

TEST(MembraneDetector, skips_a_membrane_that_does_not_tear_and_waits_for_the_next) {
  MembraneDetector detector = expecting({20.0, 50.0});
  EXPECT_TRUE(go_in(detector, 0.0, 27.9, [](double) { return 1.0; }).empty());
  EXPECT_EQ(detector.left(), 2u);
  EXPECT_TRUE(go_in(detector, 27.9, 28.1, [](double) { return 1.0; }).empty());
  EXPECT_EQ(detector.left(), 1u);
  EXPECT_EQ(go_in(detector, 28.1, 80.0, torn_at(50.0, 2.0)).size(), 1u);
  EXPECT_THAT(detector.records(), ElementsAre(Eq(std::nullopt), Optional(DoubleNear(50.0, 0.05))));
}

TEST(MembraneDetector, finds_nothing_for_the_refractory_time) {
  const auto twice = [](double depth_mm) {
    return std::max(torn_at(20.0, 2.0)(depth_mm), torn_at(21.0, 2.0)(depth_mm));
  };
  MembraneDetector detector = expecting({20.0, 22.0});
  EXPECT_EQ(go_in(detector, 0.0, 21.9, twice).size(), 1u);
  MembraneDetector keener = expecting({20.0, 22.0}, {.refractory_s = 0.1});
  EXPECT_EQ(go_in(keener, 0.0, 21.9, twice).size(), 2u);
}

TEST(MembraneDetector, takes_no_hand_that_lets_go_for_a_puncture) {
  MembraneDetector detector = expecting({20.0});
  EXPECT_TRUE(go_in(detector, 0.0, 20.0, [](double) { return 5.0; }).empty());
  double depth_mm = 20.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double speed = speed_mm_s * std::exp(-tick / 100.0);
    depth_mm += speed * period_s;
    ASSERT_FALSE(detector.step({5.0 * std::exp(-tick / 100.0), depth_mm, speed})->found) << tick;
  }
}

TEST(MembraneDetector, does_not_look_while_the_needle_stands) {
  MembraneDetector detector = expecting({20.0});
  for (int tick = 0; tick < 1000; ++tick) {
    const double force_n = tick < 500 ? 3.0 : 0.0;
    const MembraneState state = detector.step({force_n, 20.0, 0.0}).value();
    ASSERT_FALSE(state.armed);
    ASSERT_FALSE(state.found);
  }
}

TEST(MembraneDetector, says_that_tissue_is_too_rough_and_finds_nothing_in_it) {
  for (const auto& [rough_n, finds] : {std::pair(0.05, true), std::pair(0.3, false)}) {
    MembraneDetector detector = expecting({40.0});
    const auto membrane = torn_at(41.0, 3.0);
    // A wave of 1.2 mm, at 4 mm/s twice as long as the time between peak and drop.
    const auto cues = go_in(detector, 0.0, 60.0, [&, amplitude_n = rough_n](double depth_mm) {
      return 0.7 + membrane(depth_mm) + amplitude_n * std::sin(depth_mm * 2.0 * std::numbers::pi / 1.2);
    });
    EXPECT_EQ(cues.size(), finds ? 1u : 0u) << rough_n;
    EXPECT_EQ(detector.step({0.7, 60.0, speed_mm_s})->rough, !finds) << rough_n;
    detector.reset();
    EXPECT_FALSE(detector.step({0.7, 0.0, speed_mm_s})->rough) << "nothing is known of the next way";
  }
}

TEST(MembraneDetector, takes_no_membrane_for_rough_tissue) {
  MembraneDetector detector = expecting({20.0, 45.0});
  const auto first = torn_at(21.0, 2.5);
  const auto second = torn_at(44.0, 2.5);
  const auto cues = go_in(detector, 0.0, 60.0,
                          [&](double depth_mm) { return 0.7 + std::max(first(depth_mm), second(depth_mm)); });
  EXPECT_EQ(cues.size(), 2u);
  EXPECT_FALSE(detector.step({1.0, 60.0, speed_mm_s})->rough);
}

TEST(MembraneDetector, finds_nothing_in_even_noise) {
  Generator generator(1);
  std::normal_distribution<double> noise(2.0, 0.15);
  MembraneDetector detector = expecting({20.0, 45.0, 70.0});
  EXPECT_TRUE(go_in(detector, 0.0, 100.0, [&](double) { return noise(generator); }).empty());
  EXPECT_EQ(detector.left(), 0u);
}

TEST(MembraneDetector, sways_for_whole_periods_and_ends_where_it_began) {
  const CueParameters cue;
  double largest = 0.0;
  double sum = 0.0;
  for (int tick = -100; tick < 500; ++tick) {
    const double offset = cue_offset_mm(cue, tick * period_s);
    largest = std::max(largest, std::abs(offset));
    sum += offset;
    if (tick <= 0 || tick >= 300) {
      ASSERT_EQ(offset, 0.0) << tick;
    }
  }
  EXPECT_NEAR(largest, 0.2, 1e-3);
  EXPECT_NEAR(sum, 0.0, 1e-9);
}

TEST(MembraneDetector, cues_from_the_find_on) {
  MembraneDetector detector = expecting({20.0});
  const auto force_n = torn_at(20.0, 2.0);
  int swaying = 0;
  int since_found = -1;
  for (double depth_mm = 10.0; depth_mm < 30.0; depth_mm += speed_mm_s * period_s) {
    const MembraneState state = detector.step({force_n(depth_mm), depth_mm, speed_mm_s}).value();
    since_found = state.found || since_found >= 0 ? since_found + 1 : since_found;
    swaying += std::abs(state.cue_offset_mm) > 1e-9 ? 1 : 0;
    if (since_found >= 0) {
      ASSERT_NEAR(state.cue_offset_mm, cue_offset_mm({}, since_found * period_s), 1e-12);
    }
  }
  EXPECT_GE(swaying, 290);
}

TEST(MembraneDetector, expects_all_again_after_a_reset) {
  MembraneDetector detector = expecting({20.0, 50.0});
  const auto both = [](double depth_mm) {
    return depth_mm < 30.0 ? torn_at(20.0, 2.0)(depth_mm) : torn_at(50.0, 2.0)(depth_mm);
  };
  EXPECT_EQ(go_in(detector, 0.0, 70.0, both).size(), 2u);
  detector.reset();
  EXPECT_EQ(detector.left(), 2u);
  EXPECT_TRUE(detector.records().empty());
  EXPECT_EQ(go_in(detector, 0.0, 70.0, both).size(), 2u);
}

TEST(MembraneDetector, finds_or_skips_each_membrane_once_in_order_whatever_comes) {
  Generator generator(2);
  for (int trial = 0; trial < 200; ++trial) {
    MembraneDetector detector = expecting({10.0, 20.0, 40.0});
    std::size_t done = 0;
    double depth_mm = 0.0;
    for (int tick = 0; tick < 5000; ++tick) {
      const double speed = between(generator, -5.0, 30.0);
      depth_mm += speed * period_s;
      const bool found = detector.step({between(generator, -10.0, 10.0), depth_mm, speed})->found;
      ASSERT_GE(detector.records().size(), done + (found ? 1 : 0));
      ASSERT_EQ(detector.records().size() + detector.left(), 3u);
      done = detector.records().size();
    }
  }
}

TEST(MembraneDetector, allocates_nothing_after_it_is_made) {
  MembraneDetector detector = expecting({20.0});
  const auto force_n = torn_at(20.0, 2.0);
  bool found = false;
  count_allocations_of(pthread_self());
  for (double depth_mm = 0.0; depth_mm < 30.0; depth_mm += speed_mm_s * period_s) {
    found = detector.step({force_n(depth_mm), depth_mm, speed_mm_s})->found || found;
  }
  const std::uint32_t allocations = counted_allocations();
  count_allocations_of();
  EXPECT_TRUE(found);
  EXPECT_EQ(allocations, 0u);
}

TEST(MembraneDetector, answers_nonsense_with_an_error) {
  MembraneDetector detector = expecting({20.0});
  for (const double value : not_numbers) {
    EXPECT_EQ(detector.step({value, 1.0, 1.0}).error().code, Code::not_finite);
    EXPECT_EQ(detector.step({1.0, value, 1.0}).error().code, Code::not_finite);
    EXPECT_EQ(detector.step({1.0, 1.0, value}).error().code, Code::not_finite);
    const std::array depths_mm{10.0, value};
    EXPECT_EQ(MembraneDetector::create({}, depths_mm).error().code, Code::not_finite);
    EXPECT_EQ(MembraneDetector::create({.period_s = value}, {}).error().code, Code::not_finite);
    EXPECT_EQ(MembraneDetector::create({.drop_time_s = value}, {}).error().code, Code::not_finite);
    EXPECT_EQ(cue_offset_mm({}, value), 0.0);
  }
  const std::array falling{20.0, 10.0};
  EXPECT_EQ(MembraneDetector::create({}, falling).error().quantity, "membrane_depth_mm");
  const std::array<double, 17> many{};
  EXPECT_EQ(MembraneDetector::create({}, many).error().quantity, "membrane_count");
  EXPECT_EQ(MembraneDetector::create({.arm_mm = 5.0, .skip_mm = 4.0}, {}).error().quantity, "skip_mm");
}

}  // namespace
}  // namespace interlock::test
