#include "store/runs.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <chrono>

#include "store/stored_time.hpp"

namespace interlock {
namespace {

constexpr const char* select_runs =
    "SELECT number, case_number, kind, axes, outcome, begun, note, value FROM runs ";

/** ",yaw,pitch,": each name stands between two commas. */
std::string joined(const std::vector<std::string>& names) {
  std::string text = ",";
  for (const std::string& name : names) {
    text += name + ',';
  }
  return text;
}

std::vector<std::string> parted(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 1; begin < text.size();) {
    const std::size_t end = text.find(',', begin);
    names.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  return names;
}

/** The run in the statement's current row. */
KeptRun kept_run(SQLite::Statement& row) {
  KeptRun run{.number = row.getColumn(0).getInt64(),
              .case_number = row.getColumn(1).getInt64(),
              .kind = row.getColumn(2).getString(),
              .axes = parted(row.getColumn(3).getString()),
              .outcome = row.getColumn(4).getString(),
              .begun = stored_time(row.getColumn(5)),
              .note = row.getColumn(6).getString(),
              .value = nlohmann::json::parse(row.getColumn(7).getString(), nullptr, false)};
  if (!run.value.is_object()) {
    throw SQLite::Exception("run " + std::to_string(run.number) + " holds no JSON object", SQLITE_CORRUPT);
  }
  return run;
}

}  // namespace

void Runs::keep(const KeptRun& run, const nlohmann::json& samples) {
  SQLite::Statement upsert(
      database_,
      "INSERT INTO runs (number, case_number, kind, axes, outcome, begun, value, samples) VALUES (?, ?, ?, "
      "?, ?, ?, ?, ?) ON CONFLICT (number) DO UPDATE SET outcome = excluded.outcome, value = excluded.value, "
      "samples = excluded.samples");
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(samples);
  upsert.bind(1, run.number);
  upsert.bind(2, run.case_number);
  upsert.bind(3, run.kind);
  upsert.bind(4, joined(run.axes));
  upsert.bind(5, run.outcome);
  upsert.bind(6, iso_8601(run.begun));
  upsert.bind(7, run.value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  upsert.bind(8, bytes.data(), static_cast<int>(bytes.size()));
  upsert.exec();
}

std::optional<KeptRun> Runs::find(std::int64_t number) const {
  SQLite::Statement select(database_, std::string(select_runs) + "WHERE number = ?");
  select.bind(1, number);
  return select.executeStep() ? std::optional(kept_run(select)) : std::nullopt;
}

nlohmann::json Runs::samples(std::int64_t number) const {
  SQLite::Statement select(database_, "SELECT samples FROM runs WHERE number = ?");
  select.bind(1, number);
  if (!select.executeStep()) {
    return nullptr;
  }
  const SQLite::Column column = select.getColumn(0);
  const auto* bytes = static_cast<const std::uint8_t*>(column.getBlob());
  nlohmann::json samples = nlohmann::json::from_cbor(bytes, bytes + column.getBytes(), true, false);
  if (!samples.is_object()) {
    throw SQLite::Exception("the samples of run " + std::to_string(number) + " cannot be read",
                            SQLITE_CORRUPT);
  }
  return samples;
}

std::vector<KeptRun> Runs::list(const RunFilter& filter) const {
  SQLite::Statement select(
      database_, std::string(select_runs) +
                     "WHERE (?1 IS NULL OR case_number = ?1) AND (?2 IS NULL OR outcome = ?2) AND (?3 IS "
                     "NULL OR kind = ?3) AND (?4 IS NULL OR instr(axes, ?4)) AND (?5 IS NULL OR begun >= ?5) "
                     "AND (?6 IS NULL OR number < ?6) ORDER BY number DESC LIMIT ?7");
  // What is not bound is NULL.
  const auto bind = [&](int place, const auto& value) {
    if (value) {
      select.bind(place, *value);
    }
  };
  bind(1, filter.case_number);
  bind(2, filter.outcome);
  bind(3, filter.kind);
  bind(4, filter.axis ? std::optional(joined({*filter.axis})) : std::nullopt);
  bind(5, filter.since ? std::optional(iso_8601(*filter.since)) : std::nullopt);
  bind(6, filter.before);
  select.bind(7, static_cast<std::int64_t>(filter.count));
  std::vector<KeptRun> runs;
  while (select.executeStep()) {
    runs.push_back(kept_run(select));
  }
  return runs;
}

bool Runs::annotate(std::int64_t number, const std::string& note) {
  SQLite::Statement update(database_, "UPDATE runs SET note = ? WHERE number = ?");
  update.bind(1, note);
  update.bind(2, number);
  return update.exec() != 0;
}

std::int64_t Runs::newest() const {
  return database_.execAndGet("SELECT coalesce(max(number), 0) FROM runs").getInt64();
}

std::vector<std::int64_t> Runs::interrupt(const std::string& detail) {
  std::vector<std::int64_t> numbers;
  SQLite::Statement update(database_,
                           "UPDATE runs SET outcome = ?, value = json_set(value, '$.detail', ?) WHERE "
                           "outcome = ? RETURNING number");
  update.bind(1, run_interrupted);
  update.bind(2, detail);
  update.bind(3, run_goes_on);
  while (update.executeStep()) {
    numbers.push_back(update.getColumn(0).getInt64());
  }
  return numbers;
}

RunRetention Runs::retention() const {
  const auto kept = settings_.find(RunRetention::setting);
  return kept ? RunRetention{kept->value.value("count", RunRetention{}.count),
                             kept->value.value("days", RunRetention{}.days)}
              : RunRetention{};
}

void Runs::set_retention(const RunRetention& retention, UtcTime now) {
  settings_.set(RunRetention::setting, {{"count", retention.count}, {"days", retention.days}}, now);
}

void Runs::prune(UtcTime now) {
  const RunRetention stays = retention();
  SQLite::Statement remove(
      database_,
      "DELETE FROM runs WHERE outcome <> ?1 AND number NOT IN (SELECT number FROM runs ORDER BY number DESC "
      "LIMIT ?2) AND (begun < ?3 OR number NOT IN (SELECT number FROM runs ORDER BY number DESC LIMIT ?4))");
  remove.bind(1, run_goes_on);
  remove.bind(2, RunRetention::always);
  remove.bind(3, iso_8601(now - std::chrono::hours(24) * stays.days));
  remove.bind(4, stays.count);
  remove.exec();
}

}  // namespace interlock
