#include "service/drafts.hpp"

#include "service/fields.hpp"
#include "there_and_back/mode.hpp"

namespace interlock {
namespace {

DraftKind::Reading read_there_and_back(const Context& context, nlohmann::json body, std::string author) {
  Fields fields(body, {"kind", "slot", "by_counts"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto by_counts = fields.integer("by_counts", -1000, 1000);
  fields.require({{"slot", "an integer from 0 to 9"}, {"by_counts", "a distance"}});
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  co_return axis_in(context.robot, *slot).map([&](const Axis* axis) {
    return Task{ThereAndBackTask{axis->slot, static_cast<std::int32_t>(*by_counts)}, author,
                RobotMode{"there_and_back"}};
  });
}

}  // namespace

std::span<const DraftKind> there_and_back_drafts();
std::span<const DraftKind> there_and_back_drafts() {
  static constexpr DraftKind drafts[] = {{"there_and_back", "", read_there_and_back}};
  return drafts;
}

}  // namespace interlock
