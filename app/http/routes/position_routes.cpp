#include <algorithm>

#include "http/routes.hpp"
#include "service/declared_positions.hpp"
#include "service/fields.hpp"
#include "service/positions_file.hpp"
#include "service/reply.hpp"
#include "service/set_home.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** A checked request to put positions back. */
struct Restore {
  SavedPositions file;
  std::vector<std::string> axes;
};

tl::expected<Restore, Problem> restore_of(const json& body, const Robot& robot, const ilk_config_t& config) {
  Fields fields(body, {"file", "axes"});
  auto names = fields.texts("axes", 1, ILK_SLOTS);
  fields.require({{"file", "a saved file"}, {"axes", "names of axes"}});
  for (std::size_t i = 0; names && i < names->size(); ++i) {
    const std::string place = "axes[" + std::to_string(i) + "]";
    const std::string& name = (*names)[i];
    if (robot.find(name) == nullptr) {
      fields.reject(place, "is " + name + ", which this robot does not have", "an axis of " + robot.name);
    } else if (std::count(names->begin(), names->end(), name) > 1) {
      fields.reject(place, "names " + name + ", which comes twice", "each axis once");
    }
  }
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return read_positions(*fields.value("file"), robot, config, "file").map([&](SavedPositions file) {
    return Restore{std::move(file), std::move(*names)};
  });
}

std::vector<AxisRequest> requests_of(const Restore& restore, const Robot& robot) {
  std::vector<AxisRequest> requests;
  for (const Axis& axis : robot.axes) {
    if (std::find(restore.axes.begin(), restore.axes.end(), axis.name) != restore.axes.end()) {
      requests.push_back({&axis, ILK_REQUEST_RESTORE, restore.file.at_slot(axis.slot)->position_counts});
    }
  }
  return requests;
}

Problem nothing_to_undo() {
  const auto seconds = std::to_string(DeclaredPositions::undoable_for.count());
  return {.status = Status::conflict,
          .code = "NOTHING_TO_UNDO",
          .detail = "No position was declared in the last " + seconds + " s.",
          .expected = "a Set Home, Zero all or Load of the last " + seconds + " s",
          .next_step = "Home the axes whose position is wrong."};
}

json targets_of(const std::vector<AxisRequest>& requests) {
  json targets = json::object();
  for (const AxisRequest& request : requests) {
    targets[request.axis->name] = request.target_counts;
  }
  return targets;
}

}  // namespace

PositionRoutes::PositionRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/positions", viewers, [this](const Call&) -> Answering { co_return save(); });
  router.add(verb::post, "/api/positions/compare", viewers,
             [this](const Call& call) -> Answering { co_return compare(call); });
  router.add(verb::get, "/api/positions/undo", viewers,
             [this](const Call&) -> Answering { co_return declared(); });
  router.add(verb::post, "/api/positions/undo", holder, [this](const Call& call) { return undo(call); });
  router.add(verb::put, "/api/motors/restore", holder, [this](const Call& call) { return restore(call); });
  router.add(verb::post, "/api/motors/zero-all", holder, [this](const Call& call) { return zero_all(call); });
}

Reply PositionRoutes::save() const {
  return context_.need_kernel().map([this] {
    const UtcTime time = context_.clock();
    const std::string name = positions_file_name(context_.robot, time);
    return Success{.status = Status::ok,
                   .body = positions_file(context_.robot, context_.view(),
                                          open_targets(context_.robot, context_.registry), time),
                   .headers = {{"Content-Disposition", "attachment; filename=\"" + name + "\""}}};
  });
}

Reply PositionRoutes::compare(const Call& call) const {
  return parse_body(call.request)
      .and_then(
          [this](const json& body) { return read_positions(body, context_.robot, context_.config, ""); })
      .and_then([this](const SavedPositions& saved) -> Reply {
        return context_.need_kernel().map([&] {
          return Success{.body = compare_positions(saved, context_.robot, context_.config, context_.view())};
        });
      });
}

Answering PositionRoutes::restore(const Call& call) const {
  const auto request = parse_body(call.request).and_then([this](const json& body) {
    return restore_of(body, context_.robot, context_.config);
  });
  if (!request) {
    co_return fail(request.error());
  }
  const auto kernel = context_.need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  const auto fits = check_configuration(context_.config, context_.view());
  if (!fits) {
    co_return fail(refused(fits.error()));
  }
  const std::vector<AxisRequest> requests = requests_of(*request, context_.robot);
  json detail{{"saved", iso_8601(request->file.saved)}, {"axes", targets_of(requests)}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::restore, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  json rows = co_await declare_each(context_, call.caller, requests);
  co_return Success{.body = std::move(rows)};
}

Reply PositionRoutes::declared() const {
  return context_.need_kernel().map([this] {
    return Success{.body = context_.declared_positions.to_json(context_.view(), context_.config,
                                                               context_.steady_clock())};
  });
}

Answering PositionRoutes::undo(const Call& call) const {
  const auto kernel = context_.need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  if (!context_.declared_positions.is_open(context_.steady_clock())) {
    co_return fail(nothing_to_undo());
  }
  json detail{{"request", "RESTORE"}, {"what", "undo"}, {"declared", declared()->body}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::request, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  json rows = co_await undo_each(context_, call.caller);
  co_return Success{.body = std::move(rows)};
}

Answering PositionRoutes::zero_all(const Call& call) const {
  const auto kernel = context_.need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  std::vector<AxisRequest> requests;
  for (const Axis& axis : context_.robot.axes) {
    AxisRequest request{.axis = &axis, .kind = ILK_REQUEST_SET_HOME};
    if (has_switch(axis)) {
      request.not_sent_because = "it has a limit switch, which tells where its home is. Home it.";
    }
    requests.push_back(std::move(request));
  }
  json detail{{"request", "SET_HOME"}, {"what", "every axis without a switch"}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::request, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  json rows = co_await declare_each(context_, call.caller, std::move(requests));
  co_return Success{.body = std::move(rows)};
}

}  // namespace interlock::web
