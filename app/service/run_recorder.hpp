/**
 * @file
 * Keeps every motion as a run: written when it begins, every five seconds, and when it has ended.
 *
 * A run has the number of its proposal. In the store it has these values besides its columns: mode, author,
 * source, aim, verdict and detail of the proposal; robot and configuration; ended, kept, begun_tick,
 * ended_tick and duration_s; and axes, as in schema `Run` of spec/openapi.yaml. Its samples are schema
 * `RunSamples` without `id`.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "history/decimation.hpp"
#include "service/context.hpp"
#include "store/runs.hpp"

namespace interlock {

/** Belongs to the network thread, which waits neither for the store nor for a plan. */
class RunRecorder {
 public:
  /** A run has no more samples. When it has as many, every other goes, and from then on every other is
   * left out. */
  static constexpr std::size_t most_samples = 2000;
  /** After its end a run is followed for as long: axes come to rest. */
  static constexpr std::chrono::milliseconds settling{500};
  /** So often a run that goes on is kept: a kill of the app loses no more of it. */
  static constexpr std::chrono::seconds keeping{5};
  /** So many runs wait for a store that fails; beyond them the oldest is lost, and the log says so. */
  static constexpr std::size_t most_waiting = 64;

  /** The context must outlive it. */
  explicit RunRecorder(const Context& context) : context_(context) {}

  /** Sees each change of a proposal. */
  void follow(const Proposal& proposal);

  /** To be given each bucket of the decimated past, in order. */
  void add(const TickBucket& bucket);

  /** To be called some times a second: has kept what is due. */
  void check();

 private:
  /** Samples of one axis and what comes of every tick. */
  struct AxisRecord {
    std::uint32_t slot = 0;
    std::vector<std::optional<std::int32_t>> commanded;
    std::vector<std::optional<std::int32_t>> actual;
    std::int64_t largest_error = 0; /**< magnitude, counts */
    double error_squares = 0.0;
    std::uint64_t error_ticks = 0;
  };

  struct Recording {
    KeptRun run;
    std::uint32_t begun_tick = 0;
    bool has_timed_plan = false; /**< only then commanded less actual position is an error */
    std::optional<std::uint32_t> history_run;
    std::uint32_t stride = 1;              /**< of so many buckets one is a sample */
    std::uint32_t skipped = 0;             /**< buckets since the last sample */
    std::vector<std::uint32_t> ticks = {}; /**< of the samples, since the begin */
    std::vector<AxisRecord> axes = {};
    nlohmann::json plan;
    SteadyTime next = {}; /**< when it is kept next; once ended, when it has settled */
    bool ended = false;
    bool settled = false;
    bool unsaved = true;
  };

  void begin(const Proposal& proposal);
  void end(Recording& recording, const Proposal& proposal);
  void settle(Recording& recording);
  void note_ends(Recording& recording) const;
  static void add(Recording& recording, const TickBucket& bucket);
  static void thin(Recording& recording);
  [[nodiscard]] static nlohmann::json samples_of(const Recording& recording);
  [[nodiscard]] static KeptRun kept_of(const Recording& recording);
  boost::asio::awaitable<void> find_plan(Proposal proposal);
  boost::asio::awaitable<void> save();
  Recording* find(std::int64_t number);

  const Context& context_;
  std::deque<Recording> recordings_; /**< that are not over, or not kept yet; oldest first */
  std::deque<TickBucket> recent_;    /**< a run is noticed a little later than it begins */
  SteadyTime retry_ = {};            /**< not before; after a failure of the store */
  bool saving_ = false;
};

}  // namespace interlock
