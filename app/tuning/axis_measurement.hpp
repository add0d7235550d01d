/**
 * @file
 * The program that measures what the mechanics of an axis do, wherever that axis is: it looks at one reading
 * of each tick and says what the axis is to do until the next. The simulated axis of `interlock identify` and
 * a robot under the pedal (modes/identification) are measured by the same program.
 *
 * Moves go to and fro at one drive after the other. A move at a steady drive is a straight line of readings,
 * `x = x0 + v (t - T)`. Its slope is the speed at that drive; T is the lag of the motor, the tick in which
 * the drive is on its way, and after a reversal the time in which the motor takes up the play. The dead zone
 * is where the line of speed over drive meets zero.
 */
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interlock/types.h"

namespace interlock {

/** Drives at which axes are measured, as shares of the largest, in this order: an axis that does not move at
 * one is not asked to move at the next. */
inline constexpr std::array measured_shares{1.0,  1.0,  1.0,  1.0,  0.5,  0.5,  0.5,  0.5,  0.7,   0.35,
                                            0.25, 0.18, 0.15, 0.12, 0.09, 0.07, 0.05, 0.03, 0.015, 0.008};

/** Steady speed at a drive; 0 where the axis stood. */
struct DriveSpeed {
  std::uint32_t drive = 0;
  double up_counts_per_s = 0.0;   /**< towards larger positions */
  double down_counts_per_s = 0.0; /**< towards smaller ones, positive */

  bool operator==(const DriveSpeed&) const = default;
};

/** What was measured of an axis, so far or in the end. */
struct MeasuredAxis {
  std::uint32_t noise_counts = 0; /**< peak to peak at rest, in five seconds */
  /** Largest drive first, down to the first at which the axis stood. */
  boost::container::static_vector<DriveSpeed, measured_shares.size()> speeds;
  double dead_zone_drive = 0.0;         /**< up to it the axis stands */
  double full_speed_counts_per_s = 0.0; /**< at the largest drive, in the faster direction */
  double fit_percent = 0.0; /**< standard deviation of the speeds from their line, of full speed */
  double lag_s = 0.0;       /**< time constant of the speed */
  /** Farthest from the reading on which drive was last allowed until rest; nothing where no move at the
   * largest drive had a reading in every tick from there on. */
  std::optional<std::uint32_t> coast_counts = {};
  double backlash_counts = 0.0; /**< lost motion when the direction changes */
};

/** Where a measurement takes place. */
struct MeasuringRange {
  std::int32_t lowest_counts = 0;  /**< no setpoint is below */
  std::int32_t highest_counts = 0; /**< or above */
  std::int32_t way_counts = 0;     /**< of each move */

  /** The middle: a move up begins below it, one down above. */
  [[nodiscard]] std::int32_t middle_counts() const noexcept {
    return lowest_counts + (highest_counts - lowest_counts) / 2;
  }
  /** Whether an axis can be measured there: `shortest_way_counts` at least. */
  [[nodiscard]] bool is_enough() const noexcept { return way_counts >= shortest_way_counts; }

  static constexpr std::int32_t shortest_way_counts = 60;
};

/** The middle part of where an axis with these rules takes setpoints, clear of both ends. */
MeasuringRange measuring_range(const ilk_axis_config_t& rules, std::int32_t lowest_setpoint_counts,
                               std::int32_t highest_setpoint_counts) noexcept;

/** That the range is too short, for people. */
std::string too_short(const std::string& axis, const MeasuringRange& range);

/** That the axis stands where it has to move, for people. */
std::string stands_words(const std::string& axis);

/** What a tick shows of the axis. */
struct MeasuredTick {
  std::uint32_t tick = 0;
  std::int32_t position_counts = 0;
  std::uint32_t drive = 0;     /**< with which the kernel drives the axis from this tick on */
  std::uint32_t move_tick = 0; /**< in which the kernel took the MOVE that it carries out */
};

/** What the axis is to do until the next reading. */
struct MeasuringMove {
  std::int32_t target_counts = 0;
  std::uint32_t drive = 0; /**< 0: none */
};

/** Measures one axis, tick by tick. Nothing allocates but the construction. */
class AxisMeasurement {
 public:
  /** How far it came. */
  enum class State : std::uint8_t {
    measures,
    done,
    stands,   /**< at half of the largest drive, for as long as the stall rule lets it */
    held_back /**< again and again the kernel did not drive the axis */
  };

  /** So many moves, or pairs of them, are made at most: each drive in both directions. */
  static constexpr std::uint32_t most_steps = 2 * measured_shares.size();

  explicit AxisMeasurement(std::uint32_t period_us);

  /** Forgets everything; from now on an axis with these rules is measured. */
  void begin(const ilk_axis_config_t& rules, const MeasuringRange& range) noexcept;

  /** Motion was interrupted: what was under way is measured again, once the axis rests. */
  void interrupt() noexcept;

  /** Looks at the reading of a tick. Ticks may be missing. */
  [[nodiscard]] MeasuringMove see(const MeasuredTick& reading) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /** Of `most_steps`. */
  [[nodiscard]] std::uint32_t step() const noexcept { return step_; }
  /** Of the newest move. */
  [[nodiscard]] std::uint32_t drive() const noexcept { return drive_; }
  /** Noise and speeds as they come; all of it when done. */
  [[nodiscard]] const MeasuredAxis& found() const noexcept { return found_; }

 private:
  /** What a move is for. */
  enum class Move : std::uint8_t {
    none,
    approach, /**< to where the next step begins, from the side that leaves play to take up */
    strong,   /**< takes up the play, and measures it */
    tried     /**< at the drive of the step */
  };
  enum class Phase : std::uint8_t { rests, watches_noise, drives, ends };

  struct Sample {
    std::uint32_t ticks; /**< since the drive began */
    std::int32_t gone;
  };

  /** One move at a steady drive. */
  struct Line {
    double speed_counts_per_s = 0.0; /**< 0: it stood */
    double delay_s = 0.0;            /**< T of the line */
  };

  struct Mean {
    double sum = 0.0;
    double weights = 0.0;

    void add(double value, double weight = 1.0) noexcept {
      sum += weight * value;
      weights += weight;
    }
    [[nodiscard]] double value() const noexcept { return weights == 0.0 ? 0.0 : sum / weights; }
  };

  void rest(const MeasuredTick& reading) noexcept;
  void watch_noise(const MeasuredTick& reading) noexcept;
  void go_on(const MeasuredTick& reading) noexcept;
  void end_move(const MeasuredTick& reading) noexcept;
  void wait_for_rest(const MeasuredTick& reading) noexcept;
  void note_coast(bool fastest, const MeasuredTick& reading) noexcept;
  void on_rest(const MeasuredTick& reading) noexcept;
  void next(const MeasuredTick& reading) noexcept;
  void start(Move move, int direction, std::int32_t way, const MeasuredTick& reading) noexcept;
  void take(const Line& tried) noexcept;
  void retry() noexcept;
  void fit() noexcept;
  [[nodiscard]] Line line() const noexcept;
  [[nodiscard]] int step_direction() const noexcept { return step_ % 2 == 0 ? 1 : -1; }
  [[nodiscard]] std::uint32_t drive_of(double share) const noexcept;
  [[nodiscard]] std::uint32_t ticks_until_it_stands(double stall_share) const noexcept;

  const double period_s_;
  ilk_axis_config_t rules_{};
  MeasuringRange range_;
  State state_ = State::measures;
  Phase phase_ = Phase::rests;
  Move move_ = Move::none;
  std::uint32_t step_ = 0;
  std::uint32_t retries_ = 0;
  std::uint32_t seen_tick_ = 0;
  bool begun_ = false; /**< a reading was seen since `begin` or `interrupt` */
  bool noise_known_ = false;
  std::uint32_t noise_from_ = 0; /**< tick */
  std::int32_t lowest_ = 0;
  std::int32_t highest_ = 0;
  // The move.
  int direction_ = 0; /**< of the newest; 0: nobody knows */
  std::uint32_t drive_ = 0;
  std::int32_t from_ = 0;
  std::int32_t way_ = 0;
  std::int32_t target_ = 0;
  std::uint32_t longest_ = 0; /**< ticks without progress */
  std::uint32_t asked_tick_ = 0;
  std::optional<std::uint32_t> driven_since_; /**< tick before the first drive */
  std::int32_t mark_ = 0;
  std::uint32_t mark_tick_ = 0;
  bool stood_ = false;
  bool whole_ = false; /**< a reading in every tick since drive was to end */
  std::int32_t last_driven_ = 0;
  std::uint32_t coast_counts_ = 0;  /**< of the moves that were seen whole */
  bool fastest_seen_whole_ = false; /**< one at the largest drive among them */
  std::int32_t rest_at_ = 0;
  std::uint32_t rest_tick_ = 0;
  std::vector<Sample> samples_;
  // What comes of the moves.
  Line strong_;
  DriveSpeed row_;
  Mean delay_after_reversal_; /**< at the strong drive */
  Mean delay_;                /**< the play taken up; a count of error is less of it, the faster the move */
  Mean strong_speed_;
  MeasuredAxis found_;
};

}  // namespace interlock
