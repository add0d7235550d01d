#include "service/drafts.hpp"

#include "service/alignment_view.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"
#include "steering/steering_target.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** Whether the needle can bend as far; of one that is not ahead it cannot. */
tl::expected<void, Problem> check_bend(const Robot& robot, const NeedleTarget& target) {
  const auto way = steering_target(target.guide_mm);
  if (way && way->curvature_per_mm <= robot.biopsy->curvature_per_mm) {
    return {};
  }
  return fail(Problem{.status = Status::conflict,
                      .code = "UNREACHABLE",
                      .detail = "The target lies too far beside the needle's way, or not ahead of it.",
                      .expected = "a needle that is lined up with the target",
                      .next_step = "Line the robot up by a proposal of kind pose, then propose it again."});
}

/** In the guide frame; nothing: the target of the targeting. */
tl::expected<std::optional<std::array<double, 3>>, Problem> biopsy_target_of(const json& body) {
  Fields fields(body, {"kind", "target_mm"});
  const auto target_mm = fields.numbers("target_mm", 3);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return target_mm ? std::optional(std::array{(*target_mm)[0], (*target_mm)[1], (*target_mm)[2]})
                   : std::nullopt;
}

DraftKind::Reading read_biopsy(const Context& context, json body, std::string author) {
  const auto target_mm = biopsy_target_of(body);
  if (!target_mm) {
    co_return fail(target_mm.error());
  }
  co_return co_await biopsy_draft(context, *target_mm, std::move(author));
}

}  // namespace

std::span<const DraftKind> biopsy_drafts();
std::span<const DraftKind> biopsy_drafts() {
  static constexpr DraftKind drafts[] = {{"biopsy", "", read_biopsy}};
  return drafts;
}

boost::asio::awaitable<tl::expected<Task, Problem>> biopsy_draft(
    const Context& context, std::optional<std::array<double, 3>> target_mm, std::string author) {
  if (!context.biopsy.has_needle() || target_mm) {
    if (const auto kernel = context.need_kernel(); !kernel) {
      co_return fail(kernel.error());
    }
    co_return context.biopsy.draft(target_mm.value_or(std::array<double, 3>{}), context.view(), author);
  }
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  const ControlView view = context.view();
  const auto target = needle_target(context.robot, *targeting, view);
  if (!target) {
    co_return fail(target.error());
  }
  if (const auto bends = check_bend(context.robot, *target); !bends) {
    co_return fail(bends.error());
  }
  const Eigen::Vector3d& point = target->guide_mm;
  auto draft = context.biopsy.draft({point.x(), point.y(), point.z()}, view, author);
  co_return std::move(draft).map([&](Task made) {
    BiopsyTask insertion = made.work.as<BiopsyTask>();
    insertion.scanner_from_guide = target->scanner_from_guide;
    made.work = std::move(insertion);
    made.targeting_revision = revision;
    return made;
  });
}

}  // namespace interlock
