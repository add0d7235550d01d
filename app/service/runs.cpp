#include "service/runs.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <utility>

#include "store/sessions.hpp"

namespace interlock {
namespace {

using nlohmann::json;
using FoundRun = tl::expected<json, Problem>;

json retention_json(const RunRetention& retention) {
  return {{"count", retention.count}, {"days", retention.days}, {"always", RunRetention::always}};
}

/** As in a list. */
json listed_run(const KeptRun& run) {
  json shown = run.value;
  shown["id"] = run.number;
  shown["case"] = run.case_number == 0 ? json() : json(run.case_number);
  shown["kind"] = run.kind;
  shown["outcome"] = run.outcome;
  shown["begun"] = iso_8601(run.begun);
  shown["note"] = run.note;
  return shown;
}

/** With the recordings of the black box, which are files beside the heads that the recorder notes. */
json whole_run(const KeptRun& run, const std::filesystem::path& folder) {
  json shown = listed_run(run);
  // Of one that a kill of the app ended: until it was kept last.
  const json& ended = shown["ended"].is_null() ? shown["kept"] : shown["ended"];
  shown["recordings"] =
      recordings_between(folder, iso_8601(run.begun),
                         run.outcome == run_goes_on ? std::nullopt : std::optional<std::string>(ended));
  return shown;
}

FoundRun no_such_run(std::int64_t number) {
  return fail(not_found("run " + std::to_string(number), "a number that /api/runs lists"));
}

/** What the transaction finds, in the store's thread. */
template <typename Find>
CaseAnswer found_run(const Context& context, Find find) {
  auto work = [find = std::move(find)](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<FoundRun> { return find(transaction); });
  };
  auto found = co_await context.store.run(std::move(work));
  co_return std::move(found).and_then([](FoundRun run) { return run; });
}

/** What the transaction of somebody who may still change something gives; it is audited with `entry`. */
template <typename Change>
CaseAnswer changed_run(const Context& context, AuditEntry entry, Role role, Change change) {
  auto work = [entry = std::move(entry), role, change = std::move(change)](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<FoundRun> {
      if (const auto may = Sessions(transaction).need(entry.session.value_or(0), role, entry.time); !may) {
        return tl::unexpected(may.error());
      }
      FoundRun changed = change(transaction, entry.time);
      if (changed) {
        Audit(transaction).append(entry);
      }
      return changed;
    });
  };
  auto changed = co_await context.store.run(std::move(work));
  co_return std::move(changed).and_then([](FoundRun run) { return run; });
}

/** Field of a CSV file; empty for nothing. */
std::string in_unit(const json& counts, const json& axis) {
  if (counts.is_null()) {
    return "";
  }
  const double unit = axis["unit"] == "rad" ? 180.0 / std::numbers::pi : 1.0;
  std::array<char, 40> text{};
  const int size = std::snprintf(text.data(), text.size(), "%.6f",
                                 counts.get<double>() / axis["counts_per_unit"].get<double>() * unit);
  return {text.data(), static_cast<std::size_t>(size)};
}

/** The planned position at that time, counts; null before and after the plan, and where no time is planned.
 */
json planned_at(const json& plan, std::size_t place, double time_s) {
  const std::vector<double> times = plan["times_s"];
  if (plan["basis"] != "time" || times.empty() || time_s < times.front() || time_s > times.back()) {
    return nullptr;
  }
  const json& positions = plan["axes"][place]["positions_counts"];
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(times, time_s) - times.begin());
  if (after == 0) {
    return positions[0];
  }
  const double part = (time_s - times[after - 1]) / (times[after] - times[after - 1]);
  const double before = positions[after - 1];
  return before + part * (positions[after].get<double>() - before);
}

}  // namespace

CaseAnswer list_runs(const Context& context, RunFilter filter) {
  ++filter.count;
  return found_run(context, [filter = std::move(filter)](Transaction& transaction) -> FoundRun {
    const Runs runs(transaction);
    std::vector<KeptRun> found = runs.list(filter);
    const bool more = found.size() == filter.count;
    if (more) {
      found.pop_back();
    }
    json list = json::array();
    for (const KeptRun& run : found) {
      list.push_back(listed_run(run));
    }
    return json{{"runs", std::move(list)}, {"more", more}, {"retention", retention_json(runs.retention())}};
  });
}

CaseAnswer show_run(const Context& context, std::int64_t number) {
  return found_run(context, [number, folder = context.noted_heads.parent_path()](Transaction& transaction) {
    const auto run = Runs(transaction).find(number);
    return run ? FoundRun(whole_run(*run, folder)) : no_such_run(number);
  });
}

CaseAnswer samples_of_run(const Context& context, std::int64_t number) {
  return found_run(context, [number, period_us = context.config.common.period_us](Transaction& transaction) {
    json samples = Runs(transaction).samples(number);
    if (samples.is_null()) {
      return no_such_run(number);
    }
    json times = json::array();
    for (const json& tick : samples["ticks"]) {
      times.push_back(static_cast<double>(tick.get<std::uint64_t>() * period_us) / 1e6);
    }
    samples.erase("ticks");
    samples["id"] = number;
    samples["times_s"] = std::move(times);
    return FoundRun(std::move(samples));
  });
}

std::string samples_csv(const json& run, const json& samples) {
  std::string text = "time_s";
  const json& axes = run["axes"];
  for (const json& axis : axes) {
    const std::string unit = axis["unit"] == "rad" ? "deg" : axis["unit"].get<std::string>();
    for (const char* const what : {"planned", "commanded", "actual"}) {
      text += "," + axis["axis"].get<std::string>() + "_" + what + "_" + unit;
    }
  }
  text += "\n";
  const json& times = samples["times_s"];
  for (std::size_t row = 0; row < times.size(); ++row) {
    std::array<char, 40> time{};
    text.append(time.data(), static_cast<std::size_t>(
                                 std::snprintf(time.data(), time.size(), "%.6f", times[row].get<double>())));
    for (std::size_t place = 0; place < axes.size(); ++place) {
      const json& axis = samples["axes"][place];
      text += "," + in_unit(planned_at(samples["plan"], place, times[row]), axes[place]) + "," +
              in_unit(axis["commanded_counts"][row], axes[place]) + "," +
              in_unit(axis["actual_counts"][row], axes[place]);
    }
    text += "\n";
  }
  return text;
}

CaseAnswer annotate_run(const Context& context, const Caller& caller, std::int64_t number, std::string note) {
  return changed_run(context,
                     context.entry(caller, AuditKind::setting, {{"run", number}, {"changed", "note"}}),
                     Role::engineer,
                     [number, note = std::move(note), folder = context.noted_heads.parent_path()](
                         Transaction& transaction, UtcTime) {
                       Runs runs(transaction);
                       return runs.annotate(number, note) ? FoundRun(whole_run(*runs.find(number), folder))
                                                          : no_such_run(number);
                     });
}

CaseAnswer set_run_retention(const Context& context, const Caller& caller, RunRetention retention) {
  const json shown = retention_json(retention);
  return changed_run(context, context.entry(caller, AuditKind::setting, {{"run_retention", shown}}),
                     Role::admin, [retention, shown](Transaction& transaction, UtcTime now) {
                       Runs runs(transaction);
                       runs.set_retention(retention, now);
                       runs.prune(now);
                       return FoundRun(shown);
                     });
}

}  // namespace interlock
