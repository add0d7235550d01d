#include "service/drafts.hpp"

#include <limits>

#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr std::int64_t lowest_counts = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest_counts = std::numeric_limits<std::int32_t>::max();

tl::expected<Task, Problem> move_of(const json& body, const Robot& robot, const std::string& author) {
  Fields fields(body, {"kind", "slot", "target", "target_counts", "drive"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto target = fields.number("target");
  auto target_counts = fields.integer("target_counts", lowest_counts, highest_counts);
  const auto drive = fields.integer("drive", 1, highest_counts);
  fields.require({{"slot", "an integer from 0 to 9"}});
  if (fields.has("target") == fields.has("target_counts")) {
    fields.reject("target", "and target_counts: one is needed, not both",
                  "target in the axis' unit, or target_counts");
  }
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  const auto axis = axis_in(robot, *slot);
  if (!axis) {
    return fail(axis.error());
  }
  if (target) {
    const auto counts = (*axis)->to_counts(*target);
    if (!counts) {
      fields.reject("target", "is beyond every encoder",
                    "a position within the range that /api/motors shows");
      return fail(*fields.problem());
    }
    target_counts = *counts;
  }
  MoveTask move{(*axis)->slot, static_cast<std::int32_t>(*target_counts)};
  if (drive) {
    move.drive = static_cast<std::uint32_t>(*drive);
  }
  return Task{move, author};
}

DraftKind::Reading read_move(const Context& context, json body, std::string author) {
  co_return move_of(body, context.robot, author);
}

}  // namespace

std::span<const DraftKind> manual_drafts();
std::span<const DraftKind> manual_drafts() {
  static constexpr DraftKind drafts[] = {{"move", "", read_move}};
  return drafts;
}

}  // namespace interlock
