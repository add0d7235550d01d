#include "http/proposing.hpp"

#include "control/frequency_map.hpp"
#include "http/problems.hpp"

namespace interlock::web {
namespace {

using nlohmann::json;

json detail_of(const MoveDraft& draft, const Robot& robot) {
  json detail{
      {"kind", "move"}, {"axis", robot.at_slot(draft.slot)->name}, {"target_counts", draft.target_counts}};
  if (draft.drive) {
    detail["drive"] = *draft.drive;
  }
  return detail;
}

json detail_of(const HomeDraft& draft, const Robot& robot) {
  json detail{{"kind", "home"}};
  if (draft.slot) {
    detail["axis"] = robot.at_slot(*draft.slot)->name;
  }
  if (draft.step) {
    detail["step"] = *draft.step;
  }
  return detail;
}

json detail_of(const PathDraft& draft, const Robot& robot) {
  json axes = json::array();
  for (const Axis& axis : robot.axes) {
    if (((draft.program->mask() >> axis.slot) & 1u) != 0) {
      axes.push_back(axis.name);
    }
  }
  return {{"kind", "path"}, {"mode", mode_name(draft.mode)}, {"axes", std::move(axes)}};
}

json detail_of(const SweepDraft& draft, const Robot& robot) {
  return {{"kind", "sweep"},
          {"axis", robot.at_slot(draft.slot)->name},
          {"from_hz", frequency_map::hz_of(draft.steps.word(0))},
          {"to_hz", frequency_map::hz_of(draft.steps.word(draft.steps.count - 1))},
          {"count", draft.steps.count}};
}

json detail_of(const BiopsyDraft& draft, const Robot& /*robot*/) {
  return {{"kind", "biopsy"}, {"target_mm", draft.target_mm}};
}

tl::expected<Proposal, Refusal> enter(ProposalBook& book, const Draft& draft, const ControlView& view) {
  if (const auto* move = std::get_if<MoveDraft>(&draft)) {
    return book.propose(*move, view);
  }
  if (const auto* path = std::get_if<PathDraft>(&draft)) {
    return book.propose_path(*path, view);
  }
  if (const auto* biopsy = std::get_if<BiopsyDraft>(&draft)) {
    return book.propose_biopsy(*biopsy, view);
  }
  if (const auto* sweep = std::get_if<SweepDraft>(&draft)) {
    return book.propose_sweep(*sweep, view);
  }
  return book.propose_home(std::get<HomeDraft>(draft), view);
}

}  // namespace

boost::asio::awaitable<tl::expected<Proposal, Problem>> propose(const Context& context, const Caller& caller,
                                                                Draft draft) {
  const std::uint32_t stops = context.control.stops();
  json asked{{"asked", std::visit([&](const auto& each) { return detail_of(each, context.robot); }, draft)}};
  const auto announced = co_await context.announce(caller, AuditKind::proposal, std::move(asked));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (context.control.stops() != stops) {
    co_return fail(stopped_meanwhile("the proposal"));
  }
  if (const auto kernel = context.need_kernel(); !kernel) {
    co_return fail(kernel.error());
  }
  auto made = enter(context.book, draft, context.view());
  if (made && made->kind == ProposalKind::biopsy) {
    context.biopsy.begin(made->id);
  }
  co_return std::move(made).map_error(refused);
}

}  // namespace interlock::web
