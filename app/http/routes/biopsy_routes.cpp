#include <array>

#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/tip_image.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr double deepest_membrane_mm = 500.0;
constexpr double oldest_image_ms = 60'000.0;

Eigen::Vector3d point_of(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

tl::expected<Membranes, Problem> membranes_in(const json& body) {
  Fields fields(body, {"depths_mm", "next"});
  const json* given = fields.value("depths_mm");
  const auto next = fields.integer("next", 0, Biopsy::most_membranes);
  fields.require({{"depths_mm", "depths below the skin, each below the one before"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  Membranes membranes{{}, static_cast<std::size_t>(next.value_or(0))};
  double above_mm = 0.0;
  const bool fits = given->is_array() && given->size() <= Biopsy::most_membranes;
  for (std::size_t each = 0; fits && each < given->size(); ++each) {
    const json& depth = (*given)[each];
    const double depth_mm = number_of(depth).value_or(0.0);
    if (!(depth_mm > above_mm && depth_mm <= deepest_membrane_mm)) {
      const std::string place = "depths_mm[" + std::to_string(each) + "]";
      return fail(invalid(place, place + " is " + quoted(depth) + ".",
                          "a number above " + json(above_mm).dump() + ", up to 500: below the one before"));
    }
    membranes.depths_mm.push_back(above_mm = depth_mm);
  }
  if (!fits || membranes.next > membranes.depths_mm.size()) {
    return fail(invalid(fits ? "next" : "depths_mm", "there are not so many membranes",
                        "at most 16 depths, and one of them, or their number, as the next"));
  }
  return membranes;
}

}  // namespace

BiopsyRoutes::BiopsyRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/biopsy", viewers, [this](const Call&) -> Answering { co_return show(); });
  router.add(verb::put, "/api/biopsy/membranes", holder,
             [this](const Call& call) { return set_membranes(call); });
  router.add(verb::post, "/api/biopsy/membranes/reset", holder,
             [this](const Call& call) { return reset_membranes(call); });
  router.add(verb::post, "/api/biopsy/zero", holder, [this](const Call& call) { return zero(call); });
  router.add(verb::post, "/api/biopsy/images", holder,
             [this](const Call& call) -> Answering { co_return take_image(call); });
}

tl::expected<void, Problem> BiopsyRoutes::need_needle() const {
  if (!context_.biopsy.has_needle()) {
    return fail(not_found("needle for a biopsy", "a robot with a [biopsy] table in its file"));
  }
  return {};
}

/** What an open biopsy works with does not change under it. */
tl::expected<void, Problem> BiopsyRoutes::need_closed() const {
  (void)context_.view();
  if (const Proposal* open = context_.registry.open_biopsy()) {
    return fail(Problem{.status = Status::conflict,
                        .code = "BIOPSY_OPEN",
                        .detail = "Proposal " + std::to_string(open->id) + " is a biopsy that works with it.",
                        .expected = "no open biopsy",
                        .next_step = "Wait until it has ended, or abort it."});
  }
  return {};
}

/** Records what is about to change; then nothing stands in its way. */
boost::asio::awaitable<tl::expected<void, Problem>> BiopsyRoutes::record_then_recheck(const Call& call,
                                                                                      json detail) const {
  if (auto closed = need_closed(); !closed) {
    co_return closed;
  }
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::setting, std::move(detail));
  co_return announced.and_then([&] { return need_closed(); });
}

Reply BiopsyRoutes::show() const {
  return need_needle().map([&] {
    const ControlView& view = context_.view();
    return Success{.body = context_.biopsy.to_json(view, context_.registry.open_biopsy() != nullptr)};
  });
}

Answering BiopsyRoutes::set_membranes(const Call& call) const {
  auto membranes = need_needle().and_then([&] { return parse_body(call.request); }).and_then(membranes_in);
  if (!membranes) {
    co_return fail(membranes.error());
  }
  json detail{{"membranes_mm", membranes->depths_mm}, {"next", membranes->next}};
  const auto announced = co_await record_then_recheck(call, std::move(detail));
  co_return announced.and_then([&] {
    context_.biopsy.set(std::move(*membranes));
    return show();
  });
}

Answering BiopsyRoutes::reset_membranes(const Call& call) const {
  if (const auto needle = need_needle(); !needle) {
    co_return fail(needle.error());
  }
  json detail{{"membranes", "reset"}};
  const auto announced = co_await record_then_recheck(call, std::move(detail));
  co_return announced.and_then([&] {
    context_.biopsy.reset();
    return show();
  });
}

Answering BiopsyRoutes::zero(const Call& call) const {
  if (const auto needle = need_needle(); !needle) {
    co_return fail(needle.error());
  }
  json detail{{"force", "zero"}};
  const auto announced = co_await record_then_recheck(call, std::move(detail));
  co_return announced.and_then([&] { return context_.need_kernel(); })
      .and_then([&] { return context_.biopsy.zero(context_.view()); })
      .and_then([&] { return show(); });
}

Reply BiopsyRoutes::take_image(const Call& call) const {
  return need_needle().and_then([&] { return parse_body(call.request); }).and_then([&](const json& body) {
    return show_image(body);
  });
}

Reply BiopsyRoutes::show_image(const json& body) const {
  constexpr std::array<std::string_view, 2> frames{"guide", "scanner"};
  Fields fields(body, {"tip_mm", "target_mm", "age_ms", "frame"});
  const auto tip_mm = fields.numbers("tip_mm", 3);
  const auto target_mm = fields.numbers("target_mm", 3);
  const auto age_ms = fields.number("age_ms", 0.0, oldest_image_ms);
  const auto frame = fields.choice("frame", frames);
  fields.require({{"tip_mm", "the tip"}, {"age_ms", "time since the exposure"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  TipImage image;
  image.frame = frame == "scanner" ? ImageFrame::scanner : ImageFrame::guide;
  image.tip_mm = point_of(*tip_mm);
  if (target_mm) {
    image.target_mm = point_of(*target_mm);
  }
  image.age_ms = *age_ms;
  return show_tip_image(context_, image).and_then([&] { return show(); });
}

}  // namespace interlock::web
