/**
 * @file
 * The runs: every motion that was carried out, with what its axes were asked for and what they did.
 */
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "store/settings.hpp"
#include "store/store.hpp"

namespace interlock {

/** Outcome of a run that goes on, or went on when the app was killed. */
constexpr const char* run_goes_on = "running";
/** Outcome of a run that went on when the app ended. */
constexpr const char* run_interrupted = "interrupted";

/** A run as it is kept. */
struct KeptRun {
  std::int64_t number = 0;       /**< of its proposal */
  std::int64_t case_number = 0;  /**< 0: no case was open */
  std::string kind;              /**< of its proposal */
  std::vector<std::string> axes; /**< names of those that it moved */
  std::string outcome;           /**< `run_goes_on`, `run_interrupted`, or the last state of its proposal */
  UtcTime begun;
  std::string note;     /**< that somebody wrote; `Runs::keep` leaves it as it is */
  nlohmann::json value; /**< an object; service/run_recorder.hpp knows what is in it */
};

/** Which runs are asked for; what is left out does not matter. */
struct RunFilter {
  std::optional<std::int64_t> case_number = {};
  std::optional<std::string> outcome = {};
  std::optional<std::string> kind = {};
  std::optional<std::string> axis = {};    /**< one that it moved */
  std::optional<UtcTime> since = {};       /**< begun then or later */
  std::optional<std::int64_t> before = {}; /**< number below this one */
  std::size_t count = 0;                   /**< at most so many */
};

/** How many runs stay. */
struct RunRetention {
  /** Key of the setting. */
  static constexpr const char* setting = "run_retention";
  /** So many of the newest stay, however old: a clock that jumped forwards does not take all. */
  static constexpr std::int64_t always = 20;

  std::int64_t count = 2000; /**< the newest */
  std::int64_t days = 365;   /**< from when they began */
};

/** The runs in one transaction. */
class Runs {
 public:
  explicit Runs(Transaction& transaction) : database_(transaction.database()), settings_(transaction) {}

  /** Adds a run, or puts it in the place of what was kept of it before; its note stays. */
  void keep(const KeptRun& run, const nlohmann::json& samples);

  /** The run of that number. */
  [[nodiscard]] std::optional<KeptRun> find(std::int64_t number) const;

  /** The samples of the run, as they were given to `keep`; null where there is no such run. */
  [[nodiscard]] nlohmann::json samples(std::int64_t number) const;

  /** Newest first. */
  [[nodiscard]] std::vector<KeptRun> list(const RunFilter& filter) const;

  /** Puts a note in the place of the one before; false where there is no such run. */
  bool annotate(std::int64_t number, const std::string& note);

  /** The largest number; 0 where there is no run. */
  [[nodiscard]] std::int64_t newest() const;

  /** Every run that goes on was interrupted by the end of the app; `detail` says so for people. Gives their
   * numbers. */
  std::vector<std::int64_t> interrupt(const std::string& detail);

  /** What stays, as last set. */
  [[nodiscard]] RunRetention retention() const;

  /** From now on so many stay. */
  void set_retention(const RunRetention& retention, UtcTime now);

  /** Removes the runs beyond the retention but those that go on. */
  void prune(UtcTime now);

 private:
  SQLite::Database& database_;
  Settings settings_;
};

}  // namespace interlock
