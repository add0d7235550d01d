#include "tuning/gain_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace interlock {
namespace {

constexpr double step_factor = 1.5;
constexpr std::uint32_t late_ticks = 10;
constexpr double slow_share = 1.0 / 3.0;
/** A smaller gain of quality is noise. */
constexpr double least_gain = 0.995;
constexpr int most_rounds = 6;

double rounded(double gain) {
  const double digit = gain == 0.0 ? 1.0 : std::pow(10.0, std::floor(std::log10(gain)) - 2);
  return std::round(gain / digit) * digit;
}

class Search {
 public:
  Search(const Robot& robot, const ilk_config_t& config, const plant::Parameters& parameters,
         const StepOptions& options, double cruise_counts_per_s)
      : robot_(robot),
        config_(config),
        parameters_(parameters),
        options_(options),
        cruise_(cruise_counts_per_s) {}

  /** Of the worst step, or why one of them failed. */
  [[nodiscard]] RigResult<double> judge(const Gains& gains) const {
    StepOptions late = options_;
    late.gains = {gains.position_per_s, gains.velocity, gains.integral_per_s};
    late.cruise_counts_per_s = cruise_;
    StepOptions once = late;
    late.late_ticks += late_ticks;
    StepOptions slow = once;
    slow.cruise_counts_per_s = slow_share * cruise_;
    double worst = 0.0;
    for (const StepOptions& options : {once, late, slow}) {
      const auto run = run_step(robot_, config_, parameters_, options);
      if (!run) {
        return tl::unexpected(run.error());
      }
      worst = std::max(worst, figures_of(*run).rms_velocity_error_percent);
    }
    return worst;
  }

  [[nodiscard]] FoundGains improved(FoundGains best) const {
    constexpr std::array gains{&Gains::position_per_s, &Gains::velocity, &Gains::integral_per_s};
    bool better = true;
    for (int round = 0; round < most_rounds && better; ++round) {
      better = false;
      for (double Gains::* const gain : gains) {
        for (const double factor : {step_factor, 1 / step_factor}) {
          Gains tried = best.gains;
          tried.*gain = rounded(factor * tried.*gain);
          const auto error = judge(tried);
          if (error && *error < least_gain * best.rms_velocity_error_percent) {
            best.gains = tried;
            best.rms_velocity_error_percent = *error;
            better = true;
          }
        }
      }
    }
    return best;
  }

 private:
  const Robot& robot_;
  const ilk_config_t& config_;
  const plant::Parameters& parameters_;
  const StepOptions& options_;
  double cruise_;
};

}  // namespace

RigResult<FoundGains> search_gains(const Robot& robot, const ilk_config_t& config,
                                   const plant::Parameters& parameters, const StepOptions& options) {
  return run_step(robot, config, parameters, options).and_then([&](const StepRun& first) {
    const Axis& axis = *robot.find(options.axis);
    const Search search(robot, config, parameters, options, first.peak_counts_per_s);
    const Gains gains{options.gains.position_per_s.value_or(axis.gains.position_per_s),
                      options.gains.velocity.value_or(axis.gains.velocity),
                      options.gains.integral_per_s.value_or(axis.gains.integral_per_s)};
    return search.judge(gains).map([&](double error) { return search.improved({gains, error, error}); });
  });
}

}  // namespace interlock
