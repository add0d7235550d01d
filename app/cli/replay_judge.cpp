#include "cli/replay_views.hpp"

namespace interlock::cli {
namespace {

ilk_view_t view_of(const ilk_state_t& state) {
  ilk_view_t view{};
  judge_view(&state, &view);
  return view;
}

}  // namespace

std::string describe(const Violation& violation) {
  const ilk_judgement_t& judgement = violation.judgement;
  const std::string slot =
      judgement.slot < ILK_SLOTS ? ", axis in slot " + std::to_string(judgement.slot) : "";
  return "tick " + std::to_string(violation.tick) + slot + ": " + judgement.clause + ": found " +
         std::to_string(judgement.found) + ", bound " + std::to_string(judgement.bound);
}

ReplayJudge::ReplayJudge(const ilk_config_t& config)
    : config_(config), config_valid_(ilk_config_validate(&config).error == ILK_CONFIG_ERROR_NONE) {}

void ReplayJudge::add(const ilk_state_t& before, const ilk_recorded_tick_t& tick) {
  if (violation_) {
    return;
  }
  if (ticks_ == 0 || ghost_.tick != before.system.tick) {
    ghost_adopt(&ghost_, &config_, &before);
  }
  const ilk_view_t was = view_of(before);
  const ilk_view_t is = view_of(tick.picture.state);
  const ilk_tick_t seen{&config_,
                        config_valid_,
                        &tick.picture.inputs,
                        tick.request,
                        tick.request_count,
                        &tick.picture.out,
                        &was,
                        &is};
  ghost_observe(&ghost_, &seen);
  ghost_requests(&ghost_, &seen);
  for (const ilk_judge_t judge : ilk_judges) {
    const ilk_judgement_t judgement = judge(&ghost_, &seen);
    if (judgement.clause != nullptr && !violation_) {
      violation_ = {tick.tick, judgement};
    }
  }
  ghost_settle(&ghost_, &seen);
  ++ticks_;
}

}  // namespace interlock::cli
