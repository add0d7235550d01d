#include "http/routes/targeting_routes.hpp"

#include "http/alignment_view.hpp"
#include "http/problems.hpp"
#include "store/settings.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
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

void set_targeting(Transaction& transaction, const Targeting& before, const Targeting& after,
                   AuditEntry entry) {
  const json old_values = to_json(before);
  const json new_values = to_json(after);
  entry.detail = {{"setting", setting_key},
                  {"old", difference(old_values, new_values)},
                  {"new", difference(new_values, old_values)}};
  Settings(transaction).set(setting_key, new_values, entry.time);
  Audit(transaction).append(entry);
}

/** A refusal of the body is a value here, as the store did not fail. */
struct Changed {
  tl::expected<Targeting, Problem> targeting;
};

/** The hold of the motion authority by which a change is made. */
struct Hold {
  Authority::SharedNumber present;
  std::uint32_t number = 0;

  [[nodiscard]] bool lasts() const { return *present == number; }
};

Problem authority_lost() {
  return {.status = Status::conflict,
          .code = "AUTHORITY",
          .detail = "The motion authority changed before this was kept.",
          .expected = "the motion authority",
          .next_step = "Request it."};
}

}  // namespace

TargetingRoutes::TargetingRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/targeting", viewers, [this](const Call&) { return show(); });
  router.add(verb::get, "/api/targeting/alignment", viewers,
             [this](const Call&) { return show_alignment(); });
  add_change(router, "/api/targeting/registration", with_registration);
  add_change(router, "/api/targeting/current", with_reported_pose);
  add_change(router, "/api/targeting/target", with_target);
}

void TargetingRoutes::add_change(Router& router, const char* path, Change make) {
  router.add(verb::put, path, holder, [this, make](const Call& call) { return change(call, make); });
}

boost::asio::awaitable<tl::expected<Targeting, Problem>> TargetingRoutes::present() const {
  auto find = [robot = &context_.robot](Store& store) {
    return store.read([&](Transaction& transaction) { return find_targeting(transaction, *robot); });
  };
  co_return co_await context_.store.run(std::move(find));
}

Answering TargetingRoutes::show() const {
  const auto found = co_await present();
  co_return found.map([](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

Answering TargetingRoutes::show_alignment() const {
  const auto found = co_await present();
  co_return found.map([&](const Targeting& targeting) {
    return Success{.body = alignment_view(context_.robot, targeting, context_.view())};
  });
}

Answering TargetingRoutes::change(const Call& call, Change make) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  const Authority& authority = context_.authority;
  auto keep = [robot = &context_.robot, make, body = *body, session = call.caller.session,
               hold = Hold{authority.shared_number(), authority.number()},
               entry = context_.entry(call.caller, AuditKind::setting, json::object())](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<Changed> {
      if (const auto lives = Sessions(transaction).need(session, Role::engineer, entry.time); !lives) {
        return tl::unexpected(lives.error());
      }
      return find_targeting(transaction, *robot).map([&](const Targeting& before) -> Changed {
        if (!hold.lasts()) {
          return {fail(authority_lost())};
        }
        Changed after{make(before, body)};
        if (after.targeting && *after.targeting != before) {
          set_targeting(transaction, before, *after.targeting, entry);
        }
        return after;
      });
    });
  };
  const auto changed = co_await context_.store.run(std::move(keep));
  if (!changed) {
    co_return fail(changed.error());
  }
  co_return changed->targeting.map(
      [](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

}  // namespace interlock::web
