#include "http/routes/targeting_routes.hpp"

#include "http/alignment_view.hpp"
#include "http/problems.hpp"
#include "http/targeting_store.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
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

Answering TargetingRoutes::show() const {
  const auto found = co_await present_targeting(context_);
  co_return found.map([](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

Answering TargetingRoutes::show_alignment() const {
  const auto found = co_await present_targeting(context_);
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
          return {fail(authority_lost()), false};
        }
        Changed after{make(before, body)};
        if (after.targeting && *after.targeting != before) {
          set_targeting(transaction, before, *after.targeting, entry);
          after.leads_elsewhere = leads_elsewhere(before, *after.targeting);
        }
        return after;
      });
    });
  };
  const auto changed = co_await context_.store.run(std::move(keep));
  if (!changed) {
    co_return fail(changed.error());
  }
  if (changed->leads_elsewhere) {
    context_.book.end_stale();
  }
  co_return changed->targeting.map(
      [](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

}  // namespace interlock::web
