#include "http/routes/targeting_routes.hpp"

#include "http/alignment_view.hpp"
#include "http/problems.hpp"
#include "http/targeting_change.hpp"
#include "http/targeting_history.hpp"
#include "http/targeting_store.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

}  // namespace

TargetingRoutes::TargetingRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/targeting", viewers, [this](const Call&) { return show(); });
  router.add(verb::get, "/api/targeting/alignment", viewers,
             [this](const Call&) { return show_alignment(); });
  router.add(verb::get, "/api/targeting/history", viewers, [this](const Call&) { return show_history(); });
  add_change(router, "/api/targeting/registration", with_registration);
  add_change(router, "/api/targeting/current", with_reported_pose);
  add_change(router, "/api/targeting/target", with_target);
}

void TargetingRoutes::add_change(Router& router, const char* path, TargetingChange make) {
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

Answering TargetingRoutes::show_history() const {
  auto find = [now = context_.clock()](Store& store) {
    return store.read(
        [now](Transaction& transaction) -> Stored<json> { return targeting_history(transaction, now); });
  };
  const auto found = co_await context_.store.run(std::move(find));
  co_return found.map([](const json& history) { return Success{.body = history}; });
}

Answering TargetingRoutes::change(const Call& call, TargetingChange make) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  const auto changed = co_await change_targeting(context_, call.caller, ProposalSource::console, make, *body);
  co_return changed.map([](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

}  // namespace interlock::web
