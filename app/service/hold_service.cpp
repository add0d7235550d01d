#include "service/hold_service.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace interlock {

using nlohmann::json;

void HoldService::use_gate(bool in_use) {
  holds_.gate.in_use = in_use;
  publish();
}

tl::expected<void, Problem> HoldService::signal(const HoldSource& source, const igtl::GateSignal& signal,
                                                std::chrono::steady_clock::time_point came) {
  const Moment now = control_.view().moment(came);
  std::erase_if(given_,
                [&](const Given& each) { return each.signal.overdue(now) || each.source.is(source); });
  if (signal.open && !given_.empty()) {
    return fail({.status = Status::conflict,
                 .code = "GATE_SOURCE",
                 .detail = "The breathing gate takes its signal from " + given_.back().source.name + ".",
                 .expected = "one source",
                 .next_step = "Stop one of both sources."});
  }
  if (!source_ || !source_->is(source)) {
    spdlog::info("the signal of the breathing gate comes from {}", source.name);
  }
  source_ = source;
  holds_.gate.open = signal.open;
  holds_.gate.signal = DeadmanTimer(signal.validity);
  holds_.gate.signal.hold(now);
  given_.push_back({source, holds_.gate.signal});
  publish();
  return {};
}

void HoldService::begin_scan(const HoldSource& source, UtcTime time, SteadyTime now) {
  if (!holds_.scanning) {
    holds_.scanning = true;
    scan_ = {source, time, now};
    publish();
  }
}

tl::expected<void, Problem> HoldService::may_end_scan(const HoldSource& source, bool in_control) const {
  if (holds_.scanning && !in_control && !scan_.source.is(source)) {
    return fail({.status = Status::conflict,
                 .code = "SCANNING",
                 .detail = "The scan is of " + scan_.source.name + ".",
                 .expected = "its source, or whoever is in control",
                 .next_step = "Request control to end it."});
  }
  return {};
}

void HoldService::end_scan() {
  holds_.scanning = false;
  publish();
}

void HoldService::end_source(const HoldSource& source) {
  std::erase_if(given_, [&](const Given& each) { return each.source.is(source); });
  if (source_ && source_->is(source)) {
    spdlog::warn("the source of the breathing gate's signal has ended: {}", source_->name);
    source_.reset();
    holds_.gate.signal.release();
    publish();
  }
}

json HoldService::kept() const {
  json kept{{"gate_in_use", holds_.gate.in_use}, {"scan", nullptr}};
  if (holds_.scanning) {
    kept["scan"] = {
        {"session", scan_.source.session}, {"source", scan_.source.name}, {"since", iso_8601(scan_.begun)}};
  }
  return kept;
}

/** A connection has another number by now, so that a scan of one is ended by whoever is in control. */
void HoldService::restore(const json& kept, UtcTime time, SteadyTime now) {
  holds_.gate.in_use = kept.at("gate_in_use").get<bool>();
  if (const json& scan = kept.at("scan"); !scan.is_null()) {
    const UtcTime begun = parse_iso_8601(scan.at("since").get<std::string>()).value_or(time);
    holds_.scanning = true;
    scan_.source = {.session = scan.at("session").get<std::uint32_t>(),
                    .name = scan.at("source").get<std::string>()};
    scan_.begun = begun;
    scan_.since = now - std::max(UtcTime::duration::zero(), time - begun);
  }
  publish();
}

json HoldService::to_json() const {
  const ControlView& seen = control_.current();
  // It may not have seen yet that the gate is in use.
  const bool is_judged = seen.attached && seen.gate != GateState::off;
  const GateState state = is_judged ? seen.gate : GateState::no_signal;
  return {{"gate",
           {{"in_use", holds_.gate.in_use},
            {"state", gate_state_name(holds_.gate.in_use ? state : GateState::off)},
            {"source", source_ ? json(source_->name) : json()}}},
          {"scan",
           {{"active", holds_.scanning},
            {"source", holds_.scanning ? json(scan_.source.name) : json()},
            {"since", holds_.scanning ? json(iso_8601(scan_.begun)) : json()}}}};
}

json HoldService::to_json(SteadyTime now) const {
  json body = to_json();
  const std::chrono::duration<double> age = now - scan_.since;
  body["scan"]["age_s"] = holds_.scanning ? json(age.count()) : json();
  return body;
}

}  // namespace interlock
