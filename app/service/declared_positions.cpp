#include "service/declared_positions.hpp"

#include <cstdlib>
#include <utility>

#include "robot/catalog.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** Of its counter since then, as its position counts. */
std::int64_t way_since(const ilk_axis_t& before, const ilk_axis_t& now, const ilk_axis_config_t& rules) {
  const std::int64_t way = static_cast<std::int32_t>(now.raw - before.raw);
  return rules.direction_correction != 0 ? -way : way;
}

/** Whether the axis rests where it was declared, and nothing but that declaration gave it its position. */
bool stands(const AxisRequest& declared, const ilk_axis_t& before, const ilk_axis_t& now,
            const ilk_axis_config_t& rules) {
  const std::uint32_t homed = declared.kind == ILK_REQUEST_SET_HOME ? ILK_HOMED_BY_HAND : ILK_HOMED_NOT;
  const std::int64_t from_declared = std::int64_t{now.position_counts} - declared.target_counts;
  return now.homed == homed && std::abs(from_declared) <= rules.noise_counts &&
         std::abs(way_since(before, now, rules)) <= rules.noise_counts;
}

/** Whether a registration rested on the position, and does no more. */
bool carries_registration(const AxisRequest& declared, const ilk_axis_t& before) {
  const bool keeps = declared.kind == ILK_REQUEST_SET_HOME && before.homed != ILK_HOMED_NOT &&
                     before.position_counts == declared.target_counts;
  return !declared.axis->role.empty() && !keeps;
}

bool is_accepted(const json& row) {
  return row["verdict"] == catalog::name(catalog::Family::verdict, ILK_VERDICT_ACCEPTED);
}

}  // namespace

void DeclaredPositions::begin(std::string by, UtcTime time, SteadyTime now) {
  by_ = std::move(by);
  time_ = time;
  began_ = now;
  axes_.clear();
}

json DeclaredPositions::to_json(const ControlView& view, const ilk_config_t& config, SteadyTime now) const {
  if (!is_open(now)) {
    return nullptr;
  }
  json axes = json::array();
  for (const Declared& each : axes_) {
    const Axis& axis = *each.request.axis;
    const ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
    axes.push_back({{"slot", axis.slot},
                    {"axis", axis.name},
                    {"request", catalog::name(catalog::Family::request, each.request.kind)},
                    {"before_counts", each.before.position_counts},
                    {"declared_counts", each.request.target_counts},
                    {"homed_before", catalog::name(catalog::Family::homed, each.before.homed)},
                    {"carries_registration", carries_registration(each.request, each.before)},
                    {"undoable", stands(each.request, each.before, state, config.axis[axis.slot])}});
  }
  const auto left = std::chrono::ceil<std::chrono::seconds>(began_ + undoable_for - now);
  return {{"by", by_}, {"time", iso_8601(time_)}, {"left_s", left.count()}, {"axes", std::move(axes)}};
}

std::vector<AxisRequest> DeclaredPositions::undoing(const ControlView& view,
                                                    const ilk_config_t& config) const {
  std::vector<AxisRequest> requests;
  for (const Declared& each : axes_) {
    const std::uint32_t slot = each.request.axis->slot;
    const ilk_axis_t& now = view.snapshot.state.axis[slot];
    AxisRequest request{.axis = each.request.axis, .kind = ILK_REQUEST_RESTORE};
    if (!stands(each.request, each.before, now, config.axis[slot])) {
      request.not_sent_because = "it moved, or was given another position, since then.";
    }
    request.target_counts = static_cast<std::int32_t>(each.before.position_counts +
                                                      way_since(each.before, now, config.axis[slot]));
    requests.push_back(std::move(request));
  }
  return requests;
}

boost::asio::awaitable<json> declare_each(const Context& context, const Caller& caller,
                                          std::vector<AxisRequest> requests) {
  const ilk_state_t before = context.view().snapshot.state;
  DeclaredPositions& declared = context.declared_positions;
  declared.begin(caller.user, context.clock(), context.steady_clock());
  json rows = co_await ask_each(context, caller, requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (is_accepted(rows[i])) {
      declared.add(requests[i], before.axis[requests[i].axis->slot]);
    }
  }
  co_return rows;
}

boost::asio::awaitable<json> undo_each(const Context& context, const Caller& caller) {
  DeclaredPositions& declared = context.declared_positions;
  const std::vector<AxisRequest> requests = declared.undoing(context.view(), context.config);
  json rows = co_await ask_each(context, caller, requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (is_accepted(rows[i])) {
      declared.forget(*requests[i].axis);
    }
  }
  co_return rows;
}

}  // namespace interlock
