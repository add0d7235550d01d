#include "pressing_hand.hpp"

#include <cmath>
#include <vector>

namespace interlock::experiment {
namespace {

plant::SensorParameters sensor_parameters(const SensorChannel& channel, std::uint32_t noise_counts) {
  plant::SensorParameters parameters;
  parameters.name = channel.name;
  parameters.input[channel.adc - 1] =
      plant::AnalogParameters{.zero_counts = channel.reference, .noise_counts = noise_counts};
  return parameters;
}

}  // namespace

SensorChannel hand_channel() {
  return {"input_force", "Force of the hand", 2, 0.9024779072786, -1600.328423214212, 1970, "unspecified"};
}

SensorChannel needle_channel() {
  return {"needle_force", "Force of the needle", 3, -0.9024779072786, 1600.328423214212, 1780, "unspecified"};
}

SensedForce::SensedForce(const SensorChannel& channel, std::uint32_t noise_counts, const plant::Random& noise)
    : channel_(channel),
      input_(channel.adc - 1),
      sensor_(sensor_parameters(channel, noise_counts), noise),
      calibration_(ForceCalibration::create(channel, units_per_newton).value()) {
  std::vector<std::uint32_t> readings(500);
  for (std::uint32_t& reading : readings) {
    reading = read(0.0);
  }
  ZeroingRules rules;
  rules.widest_spread_n = 2.5 * (noise_counts + 1) * std::abs(channel.slope) / units_per_newton;
  calibration_ = calibration_.zeroed(readings, rules).value();
}

double SensedForce::sense(double force_n) { return calibration_.force_n(read(force_n)).value(); }

std::uint32_t SensedForce::read(double force_n) {
  sensor_.press(input_, static_cast<std::int32_t>(std::lround(force_n * units_per_newton / channel_.slope)));
  return sensor_.read()[input_];
}

PressingHand::PressingHand(std::uint64_t seed, std::uint32_t noise_counts)
    : hand_(needle::HandParameters{}, needle::Noise(seed, Stream::hand)),
      force_(hand_channel(), noise_counts, plant::Random(seed, Stream::sensor)) {}

double PressingHand::speed_mm_s(double left_mm) {
  const double force_n = force_.sense(hand_.press(period_s));
  return cooperative_speed(CooperativeParameters{}, force_n, true, left_mm).value();
}

}  // namespace interlock::experiment
