/**
 * @file
 * The cases: what registration, target and motions belong to. At most one of them is not closed. And the
 * registrations, entries and targets of them all.
 */
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "store/store.hpp"

namespace interlock {

/** How a case stands in the store. One that is open there is in force only once somebody has opened or
 * resumed it since the app was started. */
enum class CaseState { open, suspended, closed };

/** As the interface spells it: "open". */
std::string_view case_state_name(CaseState state);

/** A case as it is kept. */
struct KeptCase {
  std::int64_t number = 0; /**< from 1, never given twice */
  CaseState state = CaseState::open;
  nlohmann::json value; /**< an object; service/cases.hpp knows what is in it */
};

/** The cases in one transaction. */
class Cases {
 public:
  explicit Cases(Transaction& transaction) : database_(transaction.database()) {}

  /** The one that is not closed. */
  [[nodiscard]] std::optional<KeptCase> in_hand() const;

  /** The case of that number. */
  [[nodiscard]] std::optional<KeptCase> find(std::int64_t number) const;

  /** The newest `count`, newest first. */
  [[nodiscard]] std::vector<KeptCase> list(std::size_t count) const;

  /** Adds an open one, and gives its number. No other may be in hand. */
  std::int64_t add(const nlohmann::json& value);

  /** Keeps state and value of the case with that number. */
  void change(const KeptCase& changed);

  /** Removes a case with what was noted for it and for its runs, which stay. */
  void remove(std::int64_t number);

  /** Notes a change of its values, which that record of the audit describes. */
  void note(std::int64_t number, std::int64_t record, const nlohmann::json& change);

  /** What was noted for it: the newest `count`, newest first. */
  [[nodiscard]] nlohmann::json changes(std::int64_t number, std::size_t count) const;

 private:
  SQLite::Database& database_;
};

/** A registration that was set: when, in whose case, by which way (empty: not known), and 16 numbers,
 * row-major. */
struct KeptRegistration {
  std::int64_t case_number = 0;
  std::int64_t epoch = 0; /**< of registrations, see service/targeting.hpp */
  std::string source;
  std::array<double, 16> pose{};
};

/** The registrations that were ever set, in one transaction; those of cases that were deleted as well. */
class Registrations {
 public:
  /** So many are kept, the newest. */
  static constexpr std::int64_t most = 10'000;

  explicit Registrations(Transaction& transaction) : database_(transaction.database()) {}

  /** Keeps one more, and forgets the oldest beyond `most`. */
  void add(const KeptRegistration& set);

  /** All that are kept; throws `SQLite::Exception` for one that no app wrote. */
  [[nodiscard]] std::vector<KeptRegistration> newest_first() const;

 private:
  SQLite::Database& database_;
};

/** The entries and targets that were ever set or planned, in one transaction; those of cases that were
 * deleted as well. Points are x, y and z in mm; those that differ by 0.1 mm in each of them are the same. */
class Points {
 public:
  /** So many are kept, the newest. */
  static constexpr std::int64_t most = 10'000;

  explicit Points(Transaction& transaction) : database_(transaction.database()) {}

  /** Keeps a point that was set in that case, which is no former one any more. */
  void add(std::int64_t case_number, const std::array<double, 3>& point);

  /** Those of that case are former ones: the table moved. */
  void leave(std::int64_t case_number);

  /** Whether such a point was set in another case or before the table moved, and not since. */
  [[nodiscard]] bool is_former(std::int64_t case_number, const std::array<double, 3>& point) const;

 private:
  SQLite::Database& database_;
};

}  // namespace interlock
