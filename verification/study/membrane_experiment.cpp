#include "membrane_experiment.hpp"

#include <algorithm>
#include <array>

#include "needle/needle.hpp"
#include "needle/tissue.hpp"
#include "pressing_hand.hpp"

namespace interlock::experiment {
namespace {

constexpr double end_mm = 100.0;
constexpr std::array planned_mm{20.0, 45.0, 70.0};

/** How far a membrane gives way before it tears, about the mean of what is drawn below. */
constexpr double usual_give_mm = 1.6;

needle::TissueParameters draw(const MembraneWorld& world, std::uint64_t seed) {
  needle::Noise noise(seed, Stream::world);
  needle::TissueParameters tissue;
  tissue.texture_n = world.texture_n;
  for (int layer = 0; layer <= static_cast<int>(planned_mm.size()); ++layer) {
    tissue.layers.push_back({.thickness_mm = 25.0,
                             .cutting_n = noise.between(0.3, 1.2),
                             .stiffness_n_per_mm = noise.between(0.1, 0.4),
                             .friction_n_per_mm = noise.between(0.01, 0.03)});
  }
  for (const double depth_mm : planned_mm) {
    const needle::Membrane membrane{
        .depth_mm = depth_mm + noise.between(-world.depth_error_mm, world.depth_error_mm),
        .stiffness_n_per_mm = noise.between(0.8, 1.6),
        .puncture_n = noise.between(world.least_puncture_n, world.most_puncture_n),
        .relaxation_s = noise.between(0.02, 0.04)};
    if (!noise.chance(world.absent)) {
      tissue.membranes.push_back(membrane);
    }
  }
  return tissue;
}

/** Speed of an axis from its encoder, over the last 20 ms: one count more or less is then no jump. */
class SeenSpeed {
 public:
  double next(double position_mm) {
    double& oldest_mm = positions_mm_[tick_ % positions_mm_.size()];
    const double way_mm = position_mm - oldest_mm;
    oldest_mm = position_mm;
    ++tick_;
    return way_mm / (static_cast<double>(positions_mm_.size()) * period_s);
  }

 private:
  std::array<double, 20> positions_mm_{};
  std::size_t tick_ = 0;
};

/** Counts cues against punctures, each of which may be answered once. */
class Score {
 public:
  void cue(double time_s, const std::vector<needle::Puncture>& punctures) {
    const bool answers =
        outcome_.hits + missed_ < punctures.size() && time_s - punctures.back().time_s <= latest_cue_s;
    if (!answers) {
      ++outcome_.false_alarms;
      return;
    }
    missed_ = static_cast<std::uint32_t>(punctures.size()) - 1 - outcome_.hits;
    ++outcome_.hits;
    outcome_.latencies_s.push_back(time_s - punctures.back().time_s);
  }

  MembraneOutcome outcome(const std::vector<needle::Puncture>& punctures) {
    outcome_.punctures = static_cast<std::uint32_t>(punctures.size());
    return outcome_;
  }

 private:
  MembraneOutcome outcome_;
  std::uint32_t missed_ = 0; /**< punctures before the last that was answered, without an answer */
};

}  // namespace

MembraneOutcome pass_membranes(const MembraneWorld& world, std::uint64_t seed,
                               const MembraneParameters& parameters) {
  std::array<double, planned_mm.size()> expected_mm{};
  std::transform(planned_mm.begin(), planned_mm.end(), expected_mm.begin(),
                 [](double depth_mm) { return depth_mm + usual_give_mm; });
  MembraneDetector detector = MembraneDetector::create(parameters, expected_mm).value();
  needle::Tissue tissue(draw(world, seed), needle::Noise(seed, Stream::tissue));
  needle::Needle needle(needle::NeedleParameters{}, needle::Noise(seed, Stream::world));
  PressingHand hand(seed, world.force_noise_counts);
  SensedForce needle_force(needle_channel(), world.force_noise_counts,
                           plant::Random(seed, Stream::sensor + 100));
  SeenSpeed speed;
  Score score;
  double cue_mm = 0.0;
  double time_s = 0.0;
  bool rough = false;
  for (std::uint64_t tick = 1; needle.insertion_mm() < end_mm && time_s < longest_s; ++tick) {
    time_s = static_cast<double>(tick) * period_s;
    needle.advance(hand.speed_mm_s(end_mm + 1.0 - needle.insertion_mm()), 0.0, period_s);
    const double depth_mm = needle.seen_insertion_mm() + cue_mm;
    const double force_n = needle_force.sense(tissue.press(needle.insertion_mm() + cue_mm, period_s));
    const MembraneState state = detector.step({force_n, depth_mm, speed.next(depth_mm)}).value();
    cue_mm = state.cue_offset_mm;
    rough = rough || state.rough;
    if (state.found) {
      score.cue(time_s, tissue.punctures());
    }
  }
  MembraneOutcome outcome = score.outcome(tissue.punctures());
  outcome.rough = rough;
  return outcome;
}

}  // namespace interlock::experiment
