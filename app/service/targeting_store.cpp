#include "service/targeting_store.hpp"

#include "service/targeting.hpp"
#include "store/audit.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr const char* setting_key = "targeting";

/** What the robot's file says, until somebody sets others. */
Targeting first_targeting(const Robot& robot) {
  Targeting first;
  first.treatment_to_tip_mm = robot.probe.treatment_to_tip_mm;
  first.robot_to_entry_mm = robot.probe.robot_to_entry_mm;
  first.cannula_to_treatment_mm = robot.probe.cannula_to_treatment_mm;
  first.treatment_to_robot_at_home_mm = robot.probe.treatment_to_robot_at_home_mm;
  return first;
}

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

}  // namespace

Stored<Targeting> find_targeting(Transaction& transaction, const Robot& robot) {
  const auto setting = Settings(transaction).find(setting_key);
  if (!setting) {
    return first_targeting(robot);
  }
  return stored_targeting(setting->value).map_error([](const Problem& problem) {
    return StoreError{StoreError::Kind::damaged, "the stored targeting is unusable: " + problem.detail, "",
                      problem.expected, "Restore the store from a backup."};
  });
}

void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   const TargetingOrigin& origin, AuditEntry entry) {
  const json old_values = to_json(before);
  const json new_values = to_json(after);
  json changed = difference(new_values, old_values);
  if (before.registration_epoch != after.registration_epoch) {
    changed["registration"] = new_values["registration"];
  }
  entry.detail = {{"setting", setting_key},
                  {"source", source_name(origin.source)},
                  {"client", origin.client},
                  {"old", difference(old_values, new_values)},
                  {"new", std::move(changed)}};
  Settings(transaction).set(setting_key, to_stored(after), entry.time);
  note_targeting_change(transaction, entry, Audit(transaction).append(entry).number);
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
  co_return found.map(
      [&](const Targeting& targeting) { return judged(targeting, context.registration_epoch); });
}

}  // namespace interlock
