#include "service/targeting_store.hpp"

#include "service/targeting.hpp"
#include "store/audit.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr const char* reported_field = "reported_position";

/** Only what differs, so that the record shows the change. */
json difference(const json& values, const json& other) {
  json differing = json::object();
  for (const auto& [name, value] : values.items()) {
    if (other[name] != value) {
      differing[name] = value;
    }
  }
  return differing;
}

/** Who, when and from where. */
json origin_of(const AuditEntry& entry, std::int64_t record) {
  return {{"record", record},
          {"time", iso_8601(entry.time)},
          {"tick", entry.tick ? json(*entry.tick) : json()},
          {"user", entry.actor},
          {"source", entry.detail.at("source")},
          {"client", entry.detail.at("client")}};
}

/** Notes the change that the audit records. A change of only the reported pose is noted as the field's
 * last one and not listed: an imager reports many times a second. */
void note_change(Transaction& transaction, KeptCase& kept, const AuditEntry& entry, std::int64_t record) {
  json change = origin_of(entry, record);
  const json& fields = entry.detail.at("new");
  for (const auto& [field, value] : fields.items()) {
    kept.value["last_set"][field] = change;
  }
  if (fields.size() != 1 || !fields.contains(reported_field)) {
    change["old"] = entry.detail.at("old");
    change["new"] = fields;
    Cases(transaction).note(kept.number, record, change);
  }
}

}  // namespace

Targeting first_targeting(const Robot& robot) {
  Targeting first;
  first.case_problem = "No case is open.";
  first.treatment_to_tip_mm = robot.probe.treatment_to_tip_mm;
  first.robot_to_entry_mm = robot.probe.robot_to_entry_mm;
  first.cannula_to_treatment_mm = robot.probe.cannula_to_treatment_mm;
  first.treatment_to_robot_at_home_mm = robot.probe.treatment_to_robot_at_home_mm;
  return first;
}

Stored<Targeting> targeting_of(const KeptCase& kept) {
  auto found = stored_targeting(kept.value.value("targeting", json::object()));
  if (!found) {
    return tl::unexpected(StoreError{
        StoreError::Kind::damaged,
        "the targeting of case " + std::to_string(kept.number) + " is unusable: " + found.error().detail, "",
        found.error().expected, "Restore the store from a backup."});
  }
  found->case_number = kept.number;
  if (kept.state == CaseState::suspended) {
    found->case_problem = "The case is suspended: " + kept.value.value("reason", "");
  } else if (kept.state == CaseState::closed) {
    found->case_problem = "The case is closed.";
  }
  return *found;
}

Stored<Targeting> find_targeting(Transaction& transaction, const Robot& robot) {
  const auto kept = Cases(transaction).in_hand();
  return kept ? targeting_of(*kept) : first_targeting(robot);
}

void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   const TargetingOrigin& origin, AuditEntry entry) {
  const json old_values = to_json(before);
  const json new_values = to_json(after);
  json changed = difference(new_values, old_values);
  if (before.registration_epoch != after.registration_epoch) {
    changed["registration"] = new_values["registration"];
  }
  entry.detail = {{"setting", "targeting"},
                  {"case", after.case_number},
                  {"source", source_name(origin.source)},
                  {"client", origin.client},
                  {"old", difference(old_values, new_values)},
                  {"new", std::move(changed)}};
  Cases cases(transaction);
  if (auto kept = cases.find(after.case_number)) {
    kept->value["targeting"] = to_stored(after);
    note_change(transaction, *kept, entry, Audit(transaction).append(entry).number);
    cases.change(*kept);
  }
}

json targeting_history(Transaction& transaction, UtcTime now) {
  const Cases cases(transaction);
  const auto kept = cases.in_hand();
  return {{"now", iso_8601(now)},
          {"last_set", kept ? kept->value.value("last_set", json::object()) : json::object()},
          {"changes", kept ? cases.changes(kept->number, most_targeting_changes) : json::array()}};
}

boost::asio::awaitable<tl::expected<Alignment, Problem>> aligned(const Context& context,
                                                                 const Targeting& targeting) {
  auto work = [robot = &context.robot, targeting] { return alignment_with(*robot, targeting); };
  auto found = co_await context.work.run(std::move(work));
  if (!found) {
    co_return fail(found.error());
  }
  co_return std::move(*found);
}

boost::asio::awaitable<tl::expected<Targeting, Problem>> present_targeting(const Context& context) {
  auto find = [robot = &context.robot](Store& store) {
    return store.read([&](Transaction& transaction) { return find_targeting(transaction, *robot); });
  };
  auto found = co_await context.store.run(std::move(find));
  co_return found.map([&](const Targeting& targeting) { return judged(targeting, context.in_force); });
}

}  // namespace interlock
