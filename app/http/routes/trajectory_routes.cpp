#include <array>
#include <string_view>

#include "http/routes.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::array<std::string_view, 2> timings{"as_written", "slowed_to_fit"};

/** `?timing=slowed_to_fit`; as written without it. */
tl::expected<Timing, Problem> timing_of(const Request& request) {
  const auto query = known_query(request, {"timing"});
  if (!query) {
    return fail(query.error());
  }
  Fields fields(*query, {"timing"});
  const auto timing = fields.choice("timing", timings);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return timing == timings.back() ? Timing::slowed_to_fit : Timing::as_written;
}

}  // namespace

TrajectoryRoutes::TrajectoryRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, path, viewers, [this](const Call&) -> Answering { co_return show(); });
  router.add(verb::put, path, holder, [this](const Call& call) { return load(call); });
  router.add(verb::delete_, path, holder, [this](const Call& call) { return unload(call); });
}

Reply TrajectoryRoutes::show() const { return Success{.body = to_json(context_.trajectory)}; }

Answering TrajectoryRoutes::load(const Call& call) const {
  const auto timing = timing_of(call.request);
  if (!timing) {
    co_return fail(timing.error());
  }
  auto work = [text = call.request.body(), robot = &context_.robot, timing = *timing] {
    return read_trajectory(text, *robot, timing);
  };
  auto done = co_await context_.work.run(std::move(work));
  if (!done) {
    co_return fail(done.error());
  }
  if (!*done) {
    co_return fail(unreadable(done->error()));
  }
  const auto loaded = co_await load_trajectory(context_, call.caller, std::move(**done));
  if (!loaded) {
    co_return fail(loaded.error());
  }
  co_return show();
}

Answering TrajectoryRoutes::unload(const Call& call) const {
  json detail{{"trajectory", nullptr}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::setting, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  context_.trajectory = {};
  co_return show();
}

}  // namespace interlock::web
