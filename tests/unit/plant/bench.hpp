/**
 * @file
 * A robot with every kind of card, and a hand that drives it over the bus.
 */
#ifndef INTERLOCK_TESTS_PLANT_BENCH_HPP
#define INTERLOCK_TESTS_PLANT_BENCH_HPP

#include <filesystem>

#include "plant/plant.hpp"

namespace interlock::plant::test {

inline constexpr std::size_t kPwm = 0;           /**< switch at the upper end, edge at 0, starts at -300 */
inline constexpr std::size_t kNonPwm = 2;        /**< motor direction 0, no switch, starts at 0 */
inline constexpr std::size_t kLower = 3;         /**< switch at the lower end, edge at 0, starts at 300 */
inline constexpr std::size_t kAnalog = 4;        /**< direction correction 0, no switch, starts at 0 */
inline constexpr std::size_t kHighFrequency = 5; /**< no switch, starts at 0 */
inline constexpr std::size_t kEmpty = 8;
inline constexpr std::size_t kSensor = 9;

inline constexpr std::uint32_t kMaxDrive = 0x1FFFF;

/** A valid configuration with the cards above. */
ilk_config_t sample_robot();

/** Parameters of the sample robot without noise, bounce and backlash, so that tests can count exactly. */
Parameters exact_parameters();

/** Writes the robot as a compiled robot file, sealed with its CRC. */
void write_robot(const ilk_config_t& robot, const std::filesystem::path& path);

/** What the hand does with an axis. */
enum class Sense { kIncreasing, kDecreasing };

/** Plays the kernel: builds frames from spec/frames.md and steps the plant with the simulated clock. */
class Bench {
 public:
  explicit Bench(const Parameters& parameters, std::uint64_t seed = 7,
                 const ilk_config_t& robot = sample_robot());

  /** Drives the axis from the next tick on. */
  void drive(std::size_t slot, Sense sense, std::uint32_t drive);

  /** Zero drive from the next tick on. */
  void stop(std::size_t slot);

  /** Ticks with what is driven now; the last answer is kept. */
  void run(std::uint32_t ticks);

  void schedule(const command::Command& command, std::optional<std::uint64_t> at = std::nullopt);

  double position(std::size_t slot) const { return plant.station(slot)->position_counts(); }

  /** A word of the card's newest frame. */
  std::uint32_t word(std::size_t slot, std::size_t index) const { return reply.frame[slot][index]; }
  bool answered(std::size_t slot) const { return (reply.frames_received >> slot & 1u) != 0; }
  bool sound(std::size_t slot) const { return wire::is_sound(wire::FrameView(reply.frame[slot])); }
  std::int32_t counter(std::size_t slot) const { return static_cast<std::int32_t>(word(slot, 3)); }
  bool switch_triggered(std::size_t slot) const { return (word(slot, 2) & 0x00080000u) == 0; }

  Plant plant;
  ilk_sim_exchange_t exchange{};
  ilk_sim_reply_t reply{};
  std::uint32_t kernel_tick = 1;

 private:
  void seal(std::size_t slot);

  ilk_config_t robot_;
};

}  // namespace interlock::plant::test

#endif
