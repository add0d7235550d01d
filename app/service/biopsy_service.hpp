/**
 * @file
 * What stays from one biopsy to the next: the zeroes of both forces, the membranes that are expected, and
 * what became of them.
 *
 * Belongs to the network thread. A robot without a [biopsy] table has a desk that refuses everything.
 */
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"
#include "service/reply.hpp"

namespace interlock {

/** Depths below the skin, in mm; the membrane that is looked for next, from 0, up to their number. */
struct Membranes {
  std::vector<double> depths_mm;
  std::size_t next = 0;
};

/** What is set for the next biopsy, and what it may be. */
class BiopsyService {
 public:
  /** `robot` must outlive it. */
  explicit BiopsyService(const Robot& robot);

  [[nodiscard]] bool has_needle() const { return robot_.biopsy.has_value(); }

  /** A biopsy at a target in the guide frame (motion/biopsy_run.hpp), from where the axes are; 422 INVALID
   * names what steering cannot work with. */
  [[nodiscard]] tl::expected<Task, Problem> draft(const std::array<double, 3>& target_mm,
                                                  const ControlView& view, const std::string& author) const;

  /** That proposal was approved: it looks for the membranes from the next one on. */
  void begin(std::uint32_t proposal);

  /** Takes over which membranes the biopsy has passed. */
  void follow(const ControlView& view);

  /** Other membranes, none of which was passed but those before `next`. */
  void set(Membranes membranes);

  /** All membranes are expected again. */
  void reset();

  /** The newest readings become the zero of both forces; 409 ZEROING says what speaks against it. */
  tl::expected<void, Problem> zero(const ControlView& view);

  /** Newest force against the needle, N; nothing without a sensor, or when that says nothing new. */
  [[nodiscard]] std::optional<double> needle_force_n(const ControlView& view) const;

  /** `Biopsy` of spec/openapi.yaml. @param open a biopsy is open */
  [[nodiscard]] nlohmann::json to_json(const ControlView& view, bool open) const;

 private:
  /** What became of a membrane. */
  struct Passed {
    bool passed = false;
    std::optional<double> found_mm; /**< nothing: it was skipped */
  };

  [[nodiscard]] nlohmann::json membranes_json() const;

  const Robot& robot_;
  std::optional<ForceCalibration> hand_;
  std::optional<ForceCalibration> needle_;
  Membranes membranes_;
  std::vector<Passed> passed_; /**< one for each membrane */
  std::uint32_t proposal_ = 0; /**< that looks for membranes */
  std::size_t first_ = 0;      /**< the membrane from which on it does */
};

}  // namespace interlock
