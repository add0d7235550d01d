#include "service/drafts.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

json summary_of(const LoadedTrajectory& loaded) {
  const json whole = to_json(loaded);
  return {{"rows", whole["rows"]}, {"duration_s", whole["duration_s"]}};
}

}  // namespace

Problem unreadable(const TrajectoryError& error) {
  return {.status = Status::unprocessable_entity,
          .code = std::string(code_name(error.code)),
          .detail = error.message(),
          .field = error.column,
          .line = static_cast<std::uint32_t>(error.line),
          .expected = error.expected,
          .next_step = "Nothing was loaded. Correct the trajectory, and load it again."};
}

boost::asio::awaitable<tl::expected<void, Problem>> load_trajectory(
    const Context& context, Caller caller, TimedTrajectory trajectory,
    std::optional<std::uint32_t> targeting_revision) {
  std::vector<PathLeg> legs;
  legs.emplace_back(TimedLeg{std::move(trajectory)});
  LoadedTrajectory loaded{std::make_shared<const PathProgram>(PathProgram{std::move(legs)}), caller.user,
                          context.clock(), targeting_revision};
  json detail{{"trajectory", summary_of(loaded)}};
  auto announced = co_await context.record_then_recheck(caller, AuditKind::setting, std::move(detail));
  if (announced) {
    context.trajectory = std::move(loaded);
  }
  co_return announced;
}

}  // namespace interlock
