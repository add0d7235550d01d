#include <cmath>

#include "http/routes.hpp"
#include "service/alignment_view.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting.hpp"
#include "service/targeting_store.hpp"
#include "targeting/reach.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** Half a second of a small computer; twice as many fill few more cells. */
constexpr std::size_t reach_draws = 200'000;

/** Schema `Reach`. */
json reach_json(const KinematicsResult<Reach>& found) {
  if (!found) {
    return {{"cell_mm", 0.0}, {"centres", json::array()}, {"problem", to_json(found.error())}};
  }
  constexpr double steps_per_mm = 100.0;
  const auto rounded = [](double mm) { return std::round(mm * steps_per_mm) / steps_per_mm; };
  json centres = json::array();
  for (const Eigen::Vector3d& centre : found->shell_mm) {
    centres.push_back({rounded(centre.x()), rounded(centre.y()), rounded(centre.z())});
  }
  return {{"cell_mm", found->cell_mm}, {"centres", std::move(centres)}, {"problem", nullptr}};
}

}  // namespace

TargetingRoutes::TargetingRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/targeting", viewers, [this](const Call&) { return show(); });
  router.add(verb::get, "/api/targeting/alignment", viewers,
             [this](const Call&) { return show_alignment(); });
  router.add(verb::get, "/api/targeting/history", viewers, [this](const Call&) { return show_history(); });
  router.add(verb::get, "/api/targeting/reach", viewers, [this](const Call&) { return show_reach(); });
  add_change(router, "/api/targeting/registration", with_registration);
  router.add(verb::post, "/api/targeting/registration/expire", engineers,
             [this](const Call& call) { return expire(call); });
  add_change(router, "/api/targeting/current", with_reported_pose);
  add_change(router, "/api/targeting/target", with_target);
  add_change(router, "/api/targeting/planned", with_planned_targets);
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
  if (!found) {
    co_return fail(found.error());
  }
  auto work = [robot = &context_.robot, targeting = *found, view = context_.view()] {
    return alignment_view(*robot, targeting, view);
  };
  co_return (co_await context_.work.run(std::move(work))).map([](json body) {
    return Success{.body = std::move(body)};
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

/** The same for as long as the probe is: computed once for it. */
Answering TargetingRoutes::show_reach() {
  const auto targeting = co_await present_targeting(context_);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  const ProbeOffsets probe = probe_of(*targeting);
  if (!reach_ || reach_->probe != probe) {
    auto work = [probe, robot = &context_.robot] {
      return RobotKinematics::create(*robot, probe).and_then([&](const RobotKinematics& kinematics) {
        return reach_of(*robot, kinematics, reach_draws);
      });
    };
    auto found = co_await context_.work.run(std::move(work));
    if (!found) {
      co_return fail(found.error());
    }
    reach_ = KnownReach{probe, reach_json(*found)};
  }
  co_return Success{.body = reach_->body};
}

Answering TargetingRoutes::expire(const Call& call) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  Fields fields(*body, {"reason"});
  std::string reason = fields.line("reason", longest_reason).value_or("The table moved.");
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  const auto expired = co_await expire_registration(context_, call.caller, std::move(reason));
  co_return expired.map([](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

Answering TargetingRoutes::change(const Call& call, TargetingChange make) const {
  const auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  const auto changed = co_await change_targeting(context_, call.caller, TaskSource::console, make, *body);
  co_return changed.map([](const Targeting& targeting) { return Success{.body = to_json(targeting)}; });
}

}  // namespace interlock::web
