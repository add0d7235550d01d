/** When axes that move together arrive: docs/paths.md, "Together". */
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "closed_loop.hpp"
#include "modes/path/mode.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::minute_ticks;
using test::neuro;

constexpr double tick_ms = 1.0;

/** Seven axes, each by a share of its way of its own. */
std::vector<AxisCounts> drawn_targets(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.15, 1.0);
  std::vector<AxisCounts> targets{{0, -600},  {1, 2500}, {2, -300}, {3, 900},
                                  {4, -1100}, {6, -700}, {7, -2000}};
  for (AxisCounts& target : targets) {
    target.counts = static_cast<std::int32_t>(target.counts * share(random));
  }
  return targets;
}

/** How one axis follows its path, by what its counter says. */
class Following {
 public:
  explicit Following(const AxisCounts& target) : target_(target) {}

  void look(const ClosedLoop& loop) {
    const auto setpoint = loop.setpoint(target_.slot);
    if (!setpoint) {
      return;
    }
    const double speed = setpoint->velocity_counts_per_s;
    const double behind = setpoint->position_counts - loop.state().axis[target_.slot].position_counts;
    top_speed_ = std::max(top_speed_, std::abs(speed));
    farthest_ = std::max(farthest_, std::abs(behind));
    if (std::abs(setpoint->position_counts - target_.counts) > 1e-9) {
      rest_tick_ = loop.seen_tick() + 1;
    }
    if (std::abs(setpoint->position_counts - target_.counts) < std::abs(target_.counts) / 2.0) {
      behind_ += speed * behind;
      weight_ += speed * speed;
    }
  }

  /** Since when its path is at rest at the target. */
  [[nodiscard]] std::uint32_t rest_tick() const { return rest_tick_; }

  /** By how much later than its path it comes to the target: the shift in time that brings path and counter
   * together best over the second half of the way (least squares). */
  [[nodiscard]] double late_ms() const { return 1e3 * behind_ / weight_; }

  /** Whether it is to go no slower than its smallest drive makes it go: below, it goes in steps. */
  [[nodiscard]] bool goes_steadily() const {
    const Axis& axis = *neuro().at_slot(target_.slot);
    const AxisControlRules rules = control_rules(axis, 1000, axis.mechanics.full_speed_counts_per_s);
    return top_speed_ >= rules.piv.full_speed_counts_per_s * rules.drive.min_drive / rules.drive.max_drive;
  }

  [[nodiscard]] double farthest_counts() const { return farthest_; }
  [[nodiscard]] const AxisCounts& target() const { return target_; }

 private:
  AxisCounts target_;
  std::uint32_t rest_tick_ = 0;
  double top_speed_ = 0.0;
  double farthest_ = 0.0;
  double behind_ = 0.0;
  double weight_ = 0.0;
};

class PathArrival : public testing::TestWithParam<std::uint64_t> {
 protected:
  PathArrival() : loop_(GetParam(), 1) {
    const std::vector<AxisCounts> targets = drawn_targets(GetParam());
    for (const AxisCounts& target : targets) {
      axes_.emplace_back(target);
    }
    loop_.make_all_ready();
    const PathProgram program{{MoveLeg{targets, 0.0, 0.0}}};
    loop_.watch([this] { std::ranges::for_each(axes_, [this](Following& axis) { axis.look(loop_); }); });
    status_ = loop_.carry_out(1, test::along(program), minute_ticks);
  }

  ClosedLoop loop_;
  std::vector<Following> axes_;
  TaskStatus status_;
};

TEST_P(PathArrival, AxesArriveWithinTwoMillisecondsOfEachOtherAndEndWithinTheirDeadbands) {
  ASSERT_EQ(status_.phase, TaskPhase::done);
  double earliest_ms = 1e9;
  double latest_ms = -1e9;
  for (const Following& axis : axes_) {
    const std::uint32_t slot = axis.target().slot;
    EXPECT_EQ(axis.rest_tick(), axes_.front().rest_tick())
        << "the path of slot " << slot << " ends by itself";
    EXPECT_LE(std::abs(loop_.state().axis[slot].position_counts - axis.target().counts),
              static_cast<std::int32_t>(loop_.config().axis[slot].deadband_counts));
    if (axis.goes_steadily()) {
      earliest_ms = std::min(earliest_ms, axis.late_ms());
      latest_ms = std::max(latest_ms, axis.late_ms());
    } else {
      EXPECT_LE(axis.farthest_counts(), 2.0) << "slot " << slot << " goes in steps, from count to count";
    }
  }
  EXPECT_LE(latest_ms - earliest_ms, 2.0 * tick_ms);
  RecordProperty("spread_us", static_cast<int>(1e3 * (latest_ms - earliest_ms)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, PathArrival, testing::Range<std::uint64_t>(1, 13));

}  // namespace
}  // namespace interlock
