/**
 * @file
 * The last two minutes of each axis for plots, as the control thread decimated them.
 */
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>

#include "history/decimation.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** What a count of a force sensor's converter is. */
struct ForceScale {
  double newton_per_count = 1.0;
  double zero_counts = 0.0;

  /** Force in newtons of a reading in counts. */
  [[nodiscard]] double force_n(std::uint32_t counts) const {
    return newton_per_count * (counts - zero_counts);
  }
};

/** Of a robot with a needle. */
struct ForceScales {
  ForceScale hand;
  ForceScale needle;
};

/** Belongs to the network thread. */
class History {
 public:
  /** Two minutes. */
  static constexpr std::size_t capacity = 3636;
  /** Buckets of one answer: what a page that opens asks for takes some answers, none of which holds up others
   * for long. */
  static constexpr std::size_t most_of_an_answer = 300;

  /** @param begun_s time since 1970 at which the app began: numbers of two runs of the app are no sequence */
  explicit History(std::int64_t begun_s) : begun_s_(begun_s) {}

  /** The oldest goes when there is no room. */
  void add(const TickBucket& bucket);

  /**
   * The oldest buckets after that number, column by column: `History` of spec/openapi.yaml.
   *
   * @param after number of a bucket, as an answer before gave it; 0: from the oldest on
   */
  [[nodiscard]] nlohmann::json after(std::uint64_t after, const Robot& robot,
                                     const std::optional<ForceScales>& forces) const;

 private:
  std::int64_t begun_s_;
  std::deque<TickBucket> buckets_; /**< oldest first */
  std::uint64_t newest_ = 0;       /**< number of the newest; the first is 1 */
};

}  // namespace interlock
