/**
 * @file
 * Everything about the simulated robot that the kernel's configuration does not know.
 */
#ifndef INTERLOCK_PLANT_PARAMETERS_HPP
#define INTERLOCK_PLANT_PARAMETERS_HPP

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interlock/types.h"
#include "plant/scene.hpp"
#include "plant/wire.hpp"

namespace interlock::plant {

using Microseconds = std::chrono::duration<std::uint64_t, std::micro>;

/** A card that sees no fresh valid frame for so long drops its amplifier (spec/frames.md). */
inline constexpr Microseconds kCardWatchdog{5000};

/** One axis: motor, gear, encoder and switch. README.md gives the equations. */
struct AxisParameters {
  std::string name;
  double start_counts = 0;                   /**< position at power-on; the counter starts at 0 there */
  double dead_zone_fraction = 0.015;         /**< of `max_drive`; up to it nothing moves */
  double full_speed_counts_per_s = 1000;     /**< at `max_drive` */
  double counts_per_revolution = 5000.0 / 3; /**< HIGH_FREQUENCY only: scales the published speed map */
  Microseconds lag{5000};                    /**< time constant of the speed; coasting is speed times lag */
  double backlash_counts = 1;                /**< play between motor and encoder */
  double tool_play_counts = 0;               /**< play between encoder and tool */
  double load_fraction = 0;            /**< of the speed, that a load takes from motion to larger positions
                                          and adds to motion to smaller ones */
  double heat_droop_fraction = 0;      /**< of the speed, that a motor has lost once it is warm */
  double heat_time_s = 60;             /**< in which a motor under full drive warms, and cools at rest */
  double resonance_hz = 0;             /**< HIGH_FREQUENCY only: above the published one; negative below */
  double resonance_drift_hz = 0;       /**< and as much more below it once it is warm */
  std::uint32_t noise_counts = 1;      /**< peak-to-peak noise of the counter */
  double noise_chance = 0.001;         /**< that a reading is `noise_counts` off */
  double end_margin_counts = 60;       /**< from the soft limits to the mechanical end stops */
  double switch_hysteresis_counts = 3; /**< from the edge back to where the switch opens */
  Microseconds switch_bounce{2000};

  bool operator==(const AxisParameters&) const = default;
};

/** The values that a number may have, both ends included. */
struct Range {
  double least;
  double most;
};

/** A number of an axis that a bench may change while the plant runs: as the plant file has it, under the same
 * name. */
struct AxisKnob {
  std::string_view name;
  Range range;
  bool whole; /**< no fractions */
  double (*get)(const AxisParameters&);
  void (*set)(AxisParameters&, double);
};

inline constexpr std::size_t kAxisKnobCount = 12;
extern const std::array<AxisKnob, kAxisKnobCount> kAxisKnobs;

/** How far an axis coasts from full speed after its amplifier went off. */
double coast_counts(const AxisParameters& axis);

/** The pedal's two contacts: the opening one moves first, the other follows. */
struct PedalParameters {
  Microseconds lag{1000}; /**< from the first contact to the second */
  Microseconds bounce{3000};
};

/** What an analog input reads while nothing acts on its sensor. */
struct AnalogParameters {
  std::uint32_t zero_counts = 0;  /**< of the converter, up to 65535 */
  std::uint32_t noise_counts = 0; /**< farthest from it, either way */
};

/** A sensor card. */
struct SensorParameters {
  std::string name;
  std::array<std::optional<AnalogParameters>, wire::kAnalogInputs> input; /**< nothing: not connected */
};

struct EstopParameters {
  Microseconds bounce{2000};
};

struct Parameters {
  PedalParameters pedal;
  EstopParameters estop;
  std::array<AxisParameters, ILK_SLOTS> axis;     /**< by slot; unused where the robot has no motor card */
  std::array<SensorParameters, ILK_SLOTS> sensor; /**< by slot; unused where it has no sensor card */
  std::optional<SceneParameters> scene;           /**< nothing: the axes touch nothing */
};

/** True when the card of this type (ilk_card_t) drives a motor. */
constexpr bool drives_motor(std::uint32_t card) {
  return card == ILK_CARD_PWM || card == ILK_CARD_NON_PWM || card == ILK_CARD_ANALOG ||
         card == ILK_CARD_HIGH_FREQUENCY;
}

/**
 * Parameters for a robot without a plant file: every value as above, axes named by their slot. An axis with
 * a switch starts 300 counts from it, or a third of its range where that is nearer; others start at 0 or at
 * the soft limit next to it. Nothing is connected to a sensor card.
 */
Parameters default_parameters(const ilk_config_t& robot);

/** Position of an axis that stands `counts` from its switch, towards the range. */
double position_from_switch(const ilk_axis_config_t& axis, double counts);

}  // namespace interlock::plant

#endif
