/**
 * @file
 * Notices when the needle punctures a membrane, from the force at the needle.
 *
 * A membrane holds the needle back until it tears, and the force drops at once. The detector low-passes the
 * force and compares it with its peak of the last moments, only near the depth where the next membrane is
 * expected, while the needle goes in. Each membrane is found once or skipped, in their order. A cue shows the
 * hand a find: the insertion axis trembles for a moment. Where no membrane is, it measures by how much the
 * force falls all the same: in tissue too rough for its rule it finds nothing, and says so. The rule is a
 * proposal with numbers of our own; what the published system did is not public (docs/steering.md).
 */
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

/** The cue: the insertion setpoint sways as a sine, whole periods of it, so that it ends where it began. */
struct CueParameters {
  double amplitude_mm = 0.2;
  double frequency_hz = 10.0;
  std::size_t periods = 3;
};

/** What the cue adds to the insertion setpoint (mm), that long after its start; 0 before and after it. */
double cue_offset_mm(const CueParameters& cue, double since_s) noexcept;

/** How the detector looks at the force. */
struct MembraneParameters {
  double period_s = 0.001;        /**< of the samples */
  double cutoff_hz = 20.0;        /**< of the low-pass, first order */
  double arm_mm = 5.0;            /**< looks so far before and behind the expected depth */
  double skip_mm = 8.0;           /**< gives the membrane up so far behind it; above `arm_mm` */
  double least_peak_n = 0.5;      /**< below it nothing held the needle back */
  double least_drop_n = 0.5;      /**< from the peak */
  double least_drop_share = 0.15; /**< of the peak, where that is more */
  double drop_time_s = 0.15;      /**< between peak and drop, at most 1 s */
  double slowest_mm_s = 0.5;      /**< slower is not going in */
  double slowest_share = 0.85;    /**< of the speed at the peak: a hand that lets go is no puncture */
  double refractory_s = 0.5;      /**< after a find; also covers the cue */
  double roughest_n =
      0.14; /**< root mean square by which the force falls within `drop_time_s` where no membrane
               is, farther than `skip_mm` from any; with more of it nothing is a puncture */
  double rough_time_s = 3.0; /**< of going in there, over which that is taken; a third of it at least */
  CueParameters cue{};
};

/** One control period. */
struct MembraneSample {
  double force_n = 0.0;    /**< at the needle, positive when tissue holds it back */
  double depth_mm = 0.0;   /**< of the tip */
  double speed_mm_s = 0.0; /**< of the insertion */
};

/** What became of a membrane: depth at which it tore, or nothing where it was skipped. */
using MembraneRecord = std::optional<double>;

/** What the detector knows in one period. */
struct MembraneState {
  bool armed = false;
  bool found = false;         /**< in this very period */
  bool rough = false;         /**< the tissue: a puncture could not be told from it */
  double cue_offset_mm = 0.0; /**< for the insertion setpoint */
};

/** Notices a puncture in the force at the needle. */
class MembraneDetector {
 public:
  static constexpr std::size_t most_membranes = 16;

  /** @param depths_mm expected, increasing; at most `most_membranes` */
  static KinematicsResult<MembraneDetector> create(const MembraneParameters& parameters,
                                                   std::span<const double> depths_mm);

  /** One sample; on an error nothing is taken in, and the cue of this period is lost. */
  KinematicsResult<MembraneState> step(const MembraneSample& sample) noexcept;

  /** Membranes that are neither found nor skipped. */
  [[nodiscard]] std::size_t left() const noexcept { return count_ - next_; }

  /** What became of those that are not left, in their order. */
  [[nodiscard]] std::span<const MembraneRecord> records() const noexcept { return {records_.data(), next_}; }

  /** Expects all membranes again, as at the start. */
  void reset() noexcept;

 private:
  struct Taken {
    double force_n = 0.0; /**< low-passed */
    MembraneSample sample;
  };

  MembraneDetector(const MembraneParameters& parameters, std::span<const double> depths_mm);

  void low_pass(double force_n) noexcept;
  [[nodiscard]] bool is_clear(double depth_mm) const noexcept;
  void take(const MembraneSample& sample) noexcept;
  void measure_roughness(const MembraneSample& sample) noexcept;
  [[nodiscard]] bool is_rough() const noexcept;
  [[nodiscard]] const Taken& peak() const noexcept;
  [[nodiscard]] bool is_drop(const Taken& peak, double speed_mm_s) const noexcept;
  void close(MembraneRecord record) noexcept;

  MembraneParameters parameters_;
  std::array<double, most_membranes> depths_mm_{};
  std::array<MembraneRecord, most_membranes> records_{};
  std::size_t count_;
  std::size_t next_ = 0;
  std::vector<Taken> window_;  /**< ring of the last `drop_time_s` */
  std::size_t taken_ = 0;      /**< samples since the ring was begun */
  bool near_membrane_ = false; /**< when it was begun */
  double fall_n2_ = 0.0;       /**< mean square of the falls where no membrane is */
  std::size_t falls_ = 0;      /**< of how many samples */
  double force_n_ = 0.0;       /**< low-passed */
  bool settled_ = false;       /**< the low-pass has seen a first sample */
  std::size_t deaf_periods_ = 0;
  std::optional<std::size_t> cue_periods_; /**< since the cue began */
};

}  // namespace interlock
