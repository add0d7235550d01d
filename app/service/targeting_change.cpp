#include "service/reply.hpp"
#include "service/targeting_store.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** A refusal of the body is a value here, as the store did not fail. */
struct Changed {
  tl::expected<Targeting, Problem> targeting;
  bool leads_elsewhere = false; /**< than before: what followed from it is stale */
};

/** A pose that an imager reports moves nothing. */
bool leads_elsewhere(Targeting before, const Targeting& after) {
  before.reported_position = after.reported_position;
  return before != after;
}

/** The hold of control by which a change is made. */
struct Hold {
  MotionControl::SharedNumber present;
  std::uint32_t number = 0;

  [[nodiscard]] bool lasts() const { return *present == number; }
};

Problem control_lost() {
  return {.status = Status::conflict,
          .code = "CONTROL",
          .detail = "Control changed hands before this was kept.",
          .expected = "control of the robot",
          .next_step = "Request control."};
}

}  // namespace

boost::asio::awaitable<tl::expected<Targeting, Problem>> change_targeting(const Context& context,
                                                                          Caller caller, TaskSource source,
                                                                          TargetingChange make, json body) {
  const MotionControl& control = context.motion_control;
  auto keep = [robot = &context.robot, make, body = std::move(body), session = caller.session,
               hold = Hold{control.shared_number(), control.number()},
               origin = TargetingOrigin{source, caller.peer},
               entry = context.entry(caller, AuditKind::setting, json::object())](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<Changed> {
      if (const auto lives = Sessions(transaction).need(session, Role::engineer, entry.time); !lives) {
        return tl::unexpected(lives.error());
      }
      return find_targeting(transaction, *robot).map([&](const Targeting& before) -> Changed {
        if (!hold.lasts()) {
          return {fail(control_lost()), false};
        }
        Changed after{make(before, body)};
        if (after.targeting && *after.targeting != before) {
          set_targeting(transaction, before, *after.targeting, origin, entry);
          after.leads_elsewhere = leads_elsewhere(before, *after.targeting);
        }
        return after;
      });
    });
  };
  const auto changed = co_await context.store.run(std::move(keep));
  if (!changed) {
    co_return fail(changed.error());
  }
  if (changed->leads_elsewhere) {
    context.registry.end_stale(caller.user);
  }
  co_return changed->targeting;
}

}  // namespace interlock
